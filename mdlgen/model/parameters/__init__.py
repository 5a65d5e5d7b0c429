"""The named values that a user gave."""
