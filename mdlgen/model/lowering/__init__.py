"""Steps from a Scene to the tables of a Model, apart from those of one kind of part."""
