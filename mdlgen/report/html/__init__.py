"""The page of a run, which stands alone."""
