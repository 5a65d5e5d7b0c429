"""What a text, its script or a deck says, as tables like those that are expected."""
