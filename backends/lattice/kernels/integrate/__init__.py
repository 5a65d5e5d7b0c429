"""Steps in time: the equations of one and their tangent, the iterations that solve them, and many steps."""
