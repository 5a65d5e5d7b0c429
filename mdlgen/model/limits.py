"""Limits of a scene by the capacity of a solver's records."""

from mdlgen.spec.drive import MOST_CORNERS as MOST_CORNERS
from mdlgen.spec.motor import MOST_POINTS as MOST_POINTS
from mdlgen.spec.moving import MOST_PLACES as MOST_PLACES
