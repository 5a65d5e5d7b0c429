"""Contents of MDL files and scripts for Altair's programs, for `verify` too; the Model does not use it."""
