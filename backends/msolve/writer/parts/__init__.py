"""Parts of the machine in a script: a file for each kind, called as one is, as its template is."""
