"""What texts for Altair's programs say of a Model, and `verify` looks for; the Model knows none of it."""
