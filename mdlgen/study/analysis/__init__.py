"""Statistics over the cases of a study."""
