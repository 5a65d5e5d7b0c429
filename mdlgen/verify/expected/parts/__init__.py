"""Expected content of an MDL file for each kind of part of the machine, a file for each."""
