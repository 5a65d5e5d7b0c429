"""Fields of the records that the force laws read: of a body, a joint, a pair of bodies, a load.

A solver's record has these, by name, and beside them what it numbers its unknowns by.
"""

from __future__ import annotations

import numpy as np

from mdlgen.mechanics.arm import ARM, PRESS
from mdlgen.mechanics.curve import FOLLOWS
from mdlgen.mechanics.driven import CLUTCH, DRIVE
from mdlgen.mechanics.edge import ENDS
from mdlgen.mechanics.frame import LAW
from mdlgen.mechanics.gate import STOPS
from mdlgen.mechanics.rim import RIM

# Of a body. What every step reads of every box stands first: there may be thousands.
OF_BODY = [
    ("mass", "f8"),
    ("inertia", "f8", 3),
    ("half", "f8", 3),  # of a box; of a guide: half of its length, width and thickness
    ("exposed", "i8"),  # of a box: its side faces without a neighbour, as a bit mask
    # of a roller, and of what slides
    ("axis", "f8", 3),
    *CLUTCH,
    ("press", "f8", PRESS),  # columns as in mechanics.arm
    *ARM,
    ("way", "f8", 3),  # direction of a slide
    ("size", "f8", 2),  # radius, of a rim the greatest, and width
    ("carries", "i8"),  # 1: a roller with a mesh on it, whose turn is followed
    *RIM,
    # of a plate
    ("arc", "f8", 3),  # of a guide: radius (0: straight), middle angle, half angle
    ("side", "i8"),  # of a guide, that may be touched: as in mechanics.guide
    *ENDS,
    *DRIVE,  # of what a law of its place moves, too, see mechanics.gate
    *STOPS,  # of what slides or turns freely
    ("coupled", "i8"),  # of a roller on a shaft: ALONE, LEADER, FOLLOWER
    ("ratio", "f8"),  # and its turns for one of the roller that leads, 1: it leads or is alone
]
# A roller whose spin is its own; one that leads a shaft, and has the inertia of all; one that follows it.
ALONE, LEADER, FOLLOWER = 0, 1, 2

# Of a joint: its bodies, and arms in body axes.
ENDS_OF_JOINT = [("a", "i8"), ("b", "i8"), ("ra", "f8", 3), ("rb", "f8", 3)]
FRAMES = [("fa", "f8", 9), ("fb", "f8", 9)]  # in body axes
CONSTANTS = [("k", "f8", 6), ("c", "f8", 6)]
CURVE = FOLLOWS

# Of a pair: its bodies, its law.
BODIES = [("kind", "i8"), ("a", "i8"), ("b", "i8")]
CONTACT = [
    ("shared", "i8"),
    ("mesh", "i8"),  # number of it
    # what it remembers: sides of the box that stand before ends of a plate (mechanics.edge), or which of its
    # faces presses alone on a mesh (mechanics.mesh)
    ("beside", "i8"),
    ("spread", "f8"),  # radius of the round that a roller's force is spread as, 0: its own
    ("k", "f8"),
    ("law", "f8", LAW),  # columns as in mechanics.frame
    ("measured", "i8"),  # row of Shapes.frictions, from 1 on; 0: the law's numbers are all there is
]

LOAD = np.dtype([("body", "i8"), ("local", "f8", 3), ("force", "f8", 3), ("moment", "f8", 3)])
