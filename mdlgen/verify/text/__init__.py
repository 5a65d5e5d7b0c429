"""What of a text or a deck no number shows: statements, labels, keywords, elements."""
