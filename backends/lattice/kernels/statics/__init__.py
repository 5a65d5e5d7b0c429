"""Static equilibrium: the stiffness of a state at rest, and the iterations that find the balance."""
