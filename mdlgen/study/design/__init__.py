"""The design of a study: values that differ, cases, and the measures of each."""
