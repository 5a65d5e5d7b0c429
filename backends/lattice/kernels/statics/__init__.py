"""Static equilibrium: the stiffness of what is at rest, and the iterations that find it."""
