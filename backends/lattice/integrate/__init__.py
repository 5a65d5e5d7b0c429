"""One pass over the time of a run: its arrays, what it stores, how it ends, and passes at the same time."""
