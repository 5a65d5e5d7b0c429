"""Verifies that an MDL file, its script and its deck state the Model that the solvers run."""
