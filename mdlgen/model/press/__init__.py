"""What springs press: where it touches, and where it stands in equilibrium as the run begins."""
