"""The search for the best values."""
