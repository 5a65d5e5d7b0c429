"""What a text must say of a Model, from its tables alone: a file for each kind of entity."""
