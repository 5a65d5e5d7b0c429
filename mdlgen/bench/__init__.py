"""Run time against error: suites of cases, each run in a process of its own and judged by an oracle."""
