"""The Model that every backend reads: flat, frozen numpy tables, lowered once from a Scene."""
