"""Entities by the statement that makes them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdlgen.backends.motionview.reader.pair import Pair
from mdlgen.backends.motionview.reader.things.beams import PolyBeam
from mdlgen.backends.motionview.reader.things.bodies import Body, Ground
from mdlgen.backends.motionview.reader.things.curves import Curve
from mdlgen.backends.motionview.reader.things.data import BuiltInOption, Option, StandardOption, Table, Value
from mdlgen.backends.motionview.reader.things.drives import (
    ContactThing,
    Coupler,
    Motion,
    SolverVariable,
)
from mdlgen.backends.motionview.reader.things.forces import Bush, CoilSpring, Force, Output
from mdlgen.backends.motionview.reader.things.geometry import (
    GlobalFrame,
    GlobalPoint,
    GlobalVector,
    Marker,
    Point,
    VectorThing,
)
from mdlgen.backends.motionview.reader.things.graphics import Graphic
from mdlgen.backends.motionview.reader.things.joints import JOINTS, Joint
from mdlgen.backends.motionview.reader.things.surfaces import DeformableSurface
from mdlgen.backends.motionview.reader.things.systems import DataSet, System
from mdlgen.backends.motionview.reader.things.templates import Template
from mdlgen.backends.motionview.reader.things.thing import Thing

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.scope import Declaration, Scope
    from mdlgen.backends.motionview.reader.world import World

# By the name of the statement, without Pair at its end.
CLASSES: dict[str, type[Thing]] = {
    "Point": Point,
    "Vector": VectorThing,
    "Marker": Marker,
    "Body": Body,
    "Bush": Bush,
    "CoilSpring": CoilSpring,
    "ActionReactionForce": Force,
    "ActionOnlyForce": Force,
    "Output": Output,
    "Template": Template,
    "Graphic": Graphic,
    "Motion": Motion,
    "Contact": ContactThing,
    "DeformableSurface": DeformableSurface,
    "Curve": Curve,
    "Coupler": Coupler,
    "SolverVariable": SolverVariable,
    "PolyBeam": PolyBeam,
    "Real": Value,
    "Integer": Value,
    "String": Value,
    "Boolean": Value,
    "Filename": Value,
    "Option": Option,
    "StandardOption": StandardOption,
    "Table": Table,
    **dict.fromkeys(JOINTS, Joint),
}
BUILT_INS: dict[str, type[Thing]] = {
    "B_Ground": Ground,
    "P_Global_Origin": GlobalPoint,
    "V_Global_X": GlobalVector,
    "V_Global_Y": GlobalVector,
    "V_Global_Z": GlobalVector,
    "Global_Frame": GlobalFrame,
    "Op_Compliant": BuiltInOption,
}


def made(world: World, declaration: Declaration) -> Any:
    """The Thing, or the Pair of two, that a declaration makes."""
    if declaration.kind == "DataSet":
        return DataSet(world, declaration, declaration.child)
    if declaration.kind in ("System", "Analysis") or declaration.child is not None:
        return System(world, declaration, declaration.child)
    made_by = CLASSES.get(declaration.kind, Thing)
    if declaration.pair:
        return Pair(made_by(world, declaration, "l"), made_by(world, declaration, "r"))
    return made_by(world, declaration, "")


def system_of(world: World, scope: Scope) -> Any:
    """The System that a scope is."""
    if scope.declaration is not None:
        declaration = scope.declaration
        if declaration.members is None:
            declaration.members = made(world, declaration)
        return declaration.members
    found = world.built_ins.get("MODEL")
    if found is None:
        found = world.built_ins["MODEL"] = System(world, None, scope)
    return found


def members(found: Any) -> list[Thing]:
    """The one, or the two of a pair."""
    return [found.l, found.r] if isinstance(found, Pair) else [found]
