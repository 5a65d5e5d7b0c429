"""Kinds of contact pairs that have a law: a module for each, found by `mechanics.by_kind`.

A module is named like its number in `model.tables.contacts`, which it has as KIND. It has compiled functions
of one pair of that kind, which both solvers call through mechanics.pair and mechanics.crossing:

- `force(bodies, pair, shapes, motion, out)`: the law, into `out`; returns True if the two touch;
- `near(bodies, pair, shapes, motion, margin, ahead)`: true if their gap may be below `margin` plus their
  relative motion in `ahead`;
- `apart(bodies, pair, shapes, x, r, way)`: true if they are too far apart to meet after an approach of `way`;
- `deepest(bodies, pair)`: the depth beyond which one is about to come out at the other side of the other;
- `closing(bodies, pair, shapes, motion, ahead)`: the greatest speed at which they may come closer along what
  they could cross, in the next `ahead`;

and, where others of that name are not enough,

- `rolling(bodies, pair, shapes, motion)`: the axis about which one rolls on the other, and the curvature of
  both together there (0: none of them rolls); without it, there is no rolling resistance;
- `unseen(bodies, pair, shapes)`: bound on their approach from one state that is checked to the next; without
  it, a part of `deepest`;
- `above(bodies, pair, x, r)`: the face of the second one that the first one is on, 1 or -1, 0 where it is on
  none; without it, always 0;
- `buried(bodies, pair, shapes, x, r)`: true if the first one's centre is too deep in the second one; needed
  where SOLID is true;
- `noted(bodies, pair, shapes, motion)`: value that the pair stores in its record for the places at the
beginning
  of a step; needed where NOTES is true;
- `plate(bodies, pair, motion)`: the second one as Frame and Plate, in the axes of a guide; needed where
ON_PLATE
  is true.

`bodies` and `pair` are records as in mechanics.records, `shapes` a mechanics.shapes.Shapes, `motion` the
Motion of all bodies, x and r places and rotations as in a Motion. The functions are inlined into the dispatch
function (forceinline); so a law that they call is CALLED, see program.kernel.
"""
