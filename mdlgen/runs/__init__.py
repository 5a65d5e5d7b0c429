"""Runs as such: checkpoints to resume them from, and the provenance that determines their bits."""
