"""Files of a run, and its tables for those who work with them."""
