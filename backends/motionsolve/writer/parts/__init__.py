"""Parts of the machine in a deck: a file for each kind, called as one is."""
