"""The Model as an XML deck."""
