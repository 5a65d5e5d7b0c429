"""A value of a material from a measured motion: a tip drop, or a decay curve."""
