"""One pass over the time of a run: its arrays, stored states and ends, and passes in parallel."""
