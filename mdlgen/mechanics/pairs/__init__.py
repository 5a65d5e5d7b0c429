"""Kinds of contact pairs that have a law: a module for each, found by `mechanics.by_kind`.

A module is called as its number in `model.tables.contacts`, which it has as KIND. It has compiled functions
of one pair of that kind, which both solvers call through mechanics.pair and mechanics.crossing:

- `force(bodies, pair, shapes, motion, out)`: the law, into `out`; returns whether the two touch;
- `near(bodies, pair, shapes, motion, margin, ahead)`: whether they may be closer than `margin` and what they
  move against each other in `ahead`;
- `apart(bodies, pair, shapes, x, r, way)`: whether they are too far apart to meet where they come closer by
  `way`;
- `deepest(bodies, pair)`: the depth beyond which one is about to come out at the other side of the other;
- `closing(bodies, pair, shapes, motion, ahead)`: the greatest speed at which they may come closer along what
  they could cross, in the next `ahead`;

and, where others of that name are not enough,

- `rolling(bodies, pair, shapes, motion)`: the axis about which one rolls on the other, and the curvature of
  both together there (0: none of them rolls); without it, there is no rolling resistance;
- `unseen(bodies, pair, shapes)`: how far they may move towards each other from one state that is looked at
  to the next; without it, a part of `deepest`;
- `above(bodies, pair, x, r)`: the face of the second one that the first one is on, 1 or -1, 0 where it is on
  none; without it, always 0;
- `buried(bodies, pair, shapes, x, r)`: whether the first one's centre is deeper in the second one than it may
  be; asked for where SOLID is true;
- `noted(bodies, pair, shapes, motion)`: what the pair remembers, as its `beside`, of the places that a step
  begins with; asked for where NOTES is true;
- `plate(bodies, pair, motion)`: the second one as Frame and Plate, in the axes of a guide; asked for where
  ON_PLATE is true.

`bodies` and `pair` are records as in mechanics.records, `shapes` a mechanics.shapes.Shapes, `motion` the
Motion of all bodies, x and r places and rotations as it has them. The functions are put into what chooses
among them (forceinline); so a law that they call is CALLED, see program.kernel.
"""
