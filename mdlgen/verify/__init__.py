"""Whether a text, its script and its deck say what the Model says that the solvers run."""
