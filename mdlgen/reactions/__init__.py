"""Machines that react, without a solver: what sensors see, which rules that fires, and what is to be done."""
