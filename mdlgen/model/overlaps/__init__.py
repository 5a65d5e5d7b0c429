"""Bodies that no contact holds apart: whether they come to overlap."""
