"""The Model as MDL text, and the script that goes with it."""
