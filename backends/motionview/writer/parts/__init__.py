"""Parts of the machine in a text: a file for each kind, called as one is, and its template beside others."""
