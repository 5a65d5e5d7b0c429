"""Steps from a Scene to the tables of a Model, apart from what is of one kind of part."""
