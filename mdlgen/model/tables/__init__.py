"""The tables of a Model. Units: mm, N, g, ms, rad; rotations as 3x3 matrices, body axes in columns.

Bodies are numbered: the boxes of each sheet (row by row: index = i + j n_x), then rollers, planes, guides and
meshes.
GROUND (-1) stands for the fixed world.
"""

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints
from mdlgen.model.tables.axle import AxlePart as AxlePart
from mdlgen.model.tables.bodies import CLAMP as CLAMP
from mdlgen.model.tables.bodies import JOINT_X as JOINT_X
from mdlgen.model.tables.bodies import JOINT_Y as JOINT_Y
from mdlgen.model.tables.bodies import SUPPORT as SUPPORT
from mdlgen.model.tables.bodies import Bodies as Bodies
from mdlgen.model.tables.bodies import Bushings as Bushings
from mdlgen.model.tables.bodies import Corners as Corners
from mdlgen.model.tables.bodies import Curves as Curves
from mdlgen.model.tables.bodies import Frozen as Frozen
from mdlgen.model.tables.bodies import Plastic as Plastic
from mdlgen.model.tables.bodies import no_corners as no_corners
from mdlgen.model.tables.bodies import no_plastic as no_plastic
from mdlgen.model.tables.contacts import BOX_BOX as BOX_BOX
from mdlgen.model.tables.contacts import BOX_CYLINDER as BOX_CYLINDER
from mdlgen.model.tables.contacts import BOX_GUIDE as BOX_GUIDE
from mdlgen.model.tables.contacts import BOX_MESH as BOX_MESH
from mdlgen.model.tables.contacts import BOX_PLANE as BOX_PLANE
from mdlgen.model.tables.contacts import CYLINDER_CYLINDER as CYLINDER_CYLINDER
from mdlgen.model.tables.contacts import CYLINDER_GUIDE as CYLINDER_GUIDE
from mdlgen.model.tables.contacts import CYLINDER_MESH as CYLINDER_MESH
from mdlgen.model.tables.contacts import CYLINDER_PLANE as CYLINDER_PLANE
from mdlgen.model.tables.contacts import EXTERNAL as EXTERNAL
from mdlgen.model.tables.contacts import OF_MACHINE as OF_MACHINE
from mdlgen.model.tables.contacts import ON_PARTS as ON_PARTS
from mdlgen.model.tables.contacts import ON_PLATES as ON_PLATES
from mdlgen.model.tables.contacts import Contacts as Contacts
from mdlgen.model.tables.contacts import ExternalPairs as ExternalPairs
from mdlgen.model.tables.contacts import Pairs as Pairs
from mdlgen.model.tables.frictions import MOST_SPEEDS as MOST_SPEEDS
from mdlgen.model.tables.frictions import Frictions as Frictions
from mdlgen.model.tables.machine import ArmPart as ArmPart
from mdlgen.model.tables.machine import CoverPart as CoverPart
from mdlgen.model.tables.machine import ExternalPart as ExternalPart
from mdlgen.model.tables.machine import GuidePart as GuidePart
from mdlgen.model.tables.machine import MachinePart as MachinePart
from mdlgen.model.tables.machine import MeshPart as MeshPart
from mdlgen.model.tables.machine import OneWay as OneWay
from mdlgen.model.tables.machine import PlanePart as PlanePart
from mdlgen.model.tables.machine import Press as Press
from mdlgen.model.tables.machine import RimPart as RimPart
from mdlgen.model.tables.machine import RollerPart as RollerPart
from mdlgen.model.tables.model import AXES as AXES
from mdlgen.model.tables.model import FEW_STEPS as FEW_STEPS
from mdlgen.model.tables.model import GROUND as GROUND
from mdlgen.model.tables.model import Anchor as Anchor
from mdlgen.model.tables.model import Loads as Loads
from mdlgen.model.tables.model import Model as Model
from mdlgen.model.tables.model import Parameter as Parameter
from mdlgen.model.tables.model import RunSettings as RunSettings
from mdlgen.model.tables.model import Tension as Tension
from mdlgen.model.tables.moving import MovingPart as MovingPart
from mdlgen.model.tables.moving import StopsPart as StopsPart
from mdlgen.model.tables.reactions import Order as Order
from mdlgen.model.tables.reactions import Reactions as Reactions
from mdlgen.model.tables.reactions import RulePart as RulePart
from mdlgen.model.tables.reactions import SensorPart as SensorPart
from mdlgen.model.tables.reactions import no_reactions as no_reactions
from mdlgen.model.tables.sheets import Bend as Bend
from mdlgen.model.tables.sheets import Clamp as Clamp
from mdlgen.model.tables.sheets import Crease as Crease
from mdlgen.model.tables.sheets import Frames as Frames
from mdlgen.model.tables.sheets import SheetPart as SheetPart
from mdlgen.model.tables.sheets import ZonePart as ZonePart
from mdlgen.model.tables.sheets import thick_of as thick_of
