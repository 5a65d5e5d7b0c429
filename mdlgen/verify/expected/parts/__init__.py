"""What a text must say of each kind of part of the machine, a file for each."""
