"""Fields of the records that the force laws read: of a body, a joint, a pair of bodies, a load.

A solver's record has these, by name, and in addition the numbers of its unknowns.
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

# Fields of a body. Those that every step reads of every box are first: there may be thousands.
OF_BODY = [
    ("mass", "f8"),
    ("inertia", "f8", 3),
    ("half", "f8", 3),  # half lengths of a box; of a guide: half of its length, width and thickness
    ("exposed", "i8"),  # side faces of a box without a neighbour, as a bit mask
    # of a roller, and of what slides
    ("axis", "f8", 3),
    *CLUTCH,
    ("press", "f8", PRESS),  # columns as in mechanics.arm
    *ARM,
    ("way", "f8", 3),  # direction of a slide
    ("size", "f8", 2),  # radius, of a rim the greatest, and width
    ("carries", "i8"),  # 1: a roller with a mesh on it, whose rotation is followed
    *RIM,
    # of a plate
    ("arc", "f8", 3),  # of a guide: radius (0: straight), middle angle, half angle
    ("side", "i8"),  # of a guide, that may be touched: as in mechanics.guide
    *ENDS,
    *DRIVE,  # of what a law of its place moves, too, see mechanics.gate
    *STOPS,  # of what slides or turns freely
    ("coupled", "i8"),  # of a roller on a shaft: ALONE, LEADER, FOLLOWER
    ("ratio", "f8"),  # rotation per rotation of its leader, 1: it leads or is alone
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
    # memory of the pair: sides of the box that stand before ends of a plate (mechanics.edge), or its face
    # that presses alone on a mesh (mechanics.mesh)
    ("beside", "i8"),
    ("spread", "f8"),  # radius of the round that defines a roller's pressure, 0: its own
    ("k", "f8"),
    ("law", "f8", LAW),  # columns as in mechanics.frame
    ("measured", "i8"),  # row of Shapes.frictions, from 1 on; 0: the law's numbers alone
]

LOAD = np.dtype([("body", "i8"), ("local", "f8", 3), ("force", "f8", 3), ("moment", "f8", 3)])
