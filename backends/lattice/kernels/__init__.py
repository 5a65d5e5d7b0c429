"""All compiled code of this solver; what Python calls of it stands in `entries`, what it works on in `state`.

Rooms, from the lowest: `linear`, systems of linear equations; `contact`, pairs and the contact solve;
`integrate`, steps in time; `statics`, equilibrium. What all of them use is beside them: `forces`, and
`image` for mirrored bodies.
"""
