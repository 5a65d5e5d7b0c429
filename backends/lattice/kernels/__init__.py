"""All compiled code of this solver. `entries` has the functions that Python calls, `state` their data.

Packages, from the lowest: `linear`, systems of linear equations; `contact`, pairs and the contact solve;
`integrate`, steps in time; `statics`, equilibrium. All of them use the modules `forces`, and `image` for
mirrored bodies.
"""
