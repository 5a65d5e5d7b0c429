"""Parts of the machine in an MDL file: one module per kind, named like it; the templates are together."""
