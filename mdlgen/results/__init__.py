"""The result of a run, in the same form for every solver."""
