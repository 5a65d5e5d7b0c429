"""Expected content of an MDL file for a Model, from its tables alone: a file for each kind of entity."""
