"""Integration over time: the equations of a step, their tangent, their solution, and runs of many steps."""
