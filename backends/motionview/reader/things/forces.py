"""Bushings, coil springs and forces between bodies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.geometry import PartMarker
from mdlgen.backends.motionview.reader.things.orientation import Directions, axes
from mdlgen.backends.motionview.reader.things.thing import SIDE_LABELS, Chosen, Thing
from mdlgen.backends.motionview.reader.things.vectors import GLOBAL, Axes, minus, one_axis
from mdlgen.backends.motionview.reader.world import Vector

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.scope import Declaration
    from mdlgen.backends.motionview.reader.things.joints import Joint
    from mdlgen.backends.motionview.reader.world import World

# Number of arguments after the word for the form of a stiffness or a force.
TOKENS = {"LIN": 1, "CRV": 3, "SPL3D": 4, "EXPR": 1, "USER": 1}
GROUPS = ("k", "c", "kt", "ct")
Components = tuple[float | str, float | str, float | str]


class Laws:
    """Reads `LIN, 5` and the like from the arguments of a statement, one after the other."""

    def __init__(self, thing: Thing, chosen: Chosen):
        self.thing = thing
        self.statement = chosen.statement
        self.scope = chosen.scope
        self.at = chosen.first
        self.curves: list[tuple[str, str, str] | None] = []  # of each law so far: curve, method, variable

    def law(self, pasted: bool = False) -> float | str:
        """A number for LIN, else the word and what follows it; `pasted`: of EXPR the expression as the solver
        gets it."""
        word = self.statement.arg(self.at).upper()
        if word not in TOKENS:
            trouble = Trouble("keyword", f"LIN, CRV, SPL3D or EXPR is due here, not {word or 'nothing'}")
            trouble.place = self.statement.place(self.at)
            raise trouble
        self.at += 1 + TOKENS[word]
        self.curves.append(self._curve() if word == "CRV" else None)
        if word == "LIN":
            return self.thing.number(self.at - 1, self.statement, self.scope)
        if word == "EXPR" and pasted:
            return str(self.thing.given(self.at - 1, self.statement, self.scope))
        return ", ".join((word, *self.statement.args[self.at - TOKENS[word] : self.at]))

    def _curve(self) -> tuple[str, str, str]:
        """Name of the curve, word of the method, solver expression of the independent variable, pasted."""
        thing, at = self.thing, self.at - TOKENS["CRV"]
        curve = thing.given(at, self.statement, self.scope)
        if getattr(curve, "kind", "") != "Curve":
            raise thing.wrong(self.statement, at, "a Curve", curve)
        return (
            curve.name,
            self.statement.arg(at + 1).upper(),
            str(thing.given(at + 2, self.statement, self.scope)),
        )

    def number(self) -> float:
        """A plain number."""
        self.at += 1
        return self.thing.number(self.at - 1, self.statement, self.scope)


class _Link(Thing):
    """Something between two bodies with a marker on each."""

    def p_b1(self) -> Any:
        return self.related(2, "Body")

    def p_b2(self) -> Any:
        return self.related(3, "Body")

    def start(self) -> Vector:
        """Place of marker i."""
        return self.position(4)

    def end(self) -> Vector:
        """Place of marker j."""
        return self.start()

    def natural(self) -> Axes:
        """Axes of both where none are set."""
        return GLOBAL

    def p_axes(self) -> Axes:
        """Axes of i and j."""
        chosen = self.chosen("setorientation", self.part)
        if chosen is None:
            return self.natural()
        origin = self.start()
        twin = self.twin() if chosen.mirrored else self
        return axes(self, twin.start() if isinstance(twin, _Link) else origin, origin, chosen)

    def p_i(self) -> PartMarker:
        return self._part("i", "Marker I", "b1", self.start)

    def p_j(self) -> PartMarker:
        return self._part("j", "Marker J", "b2", self.end)

    def _part(self, word: str, title: str, body: str, origin: Any) -> PartMarker:
        return PartMarker(self, word, title, lambda: self.ask(body), origin, lambda: self.ask("axes"), word)

    part = ""

    def markers(self) -> list[PartMarker]:
        """Markers of the force in the deck."""
        return [self.ask("i"), self.ask("j")]

    def marker_records(self) -> list[tuple[str, dict[str, Any]]]:
        """i and j, without making them: a sheet has two for each of its many bushings."""
        label, tail = self.ask("label"), f".{self.side}" if self.side else ""
        suffix = SIDE_LABELS[self.side]
        label, axes = label.removesuffix(suffix), self.ask("axes")
        ends = (("i", "b1", self.start()), ("j", "b2", self.end()))
        return [
            (
                f"{self.base}.{word}{tail}",
                {
                    "label": f"{label}-Marker {word.upper()}{suffix}",
                    "body": self.ask(body).name,
                    "origin": origin,
                    "axes": axes,
                },
            )
            for word, body, origin in ends
        ]


class Bush(_Link):
    """`*Bush( name, label, body_1, body_2, point )`, or the bushing that a joint is with compliance."""

    kind = "Bush"

    def __init__(
        self, world: World, declaration: Declaration, side: str, part: str = "", joint: Joint | None = None
    ):
        super().__init__(world, declaration, side)
        self.part = part
        self.joint = joint
        if part:
            self.call(f"{self.base}.bush")

    def twin(self) -> Thing:
        return super().twin().ask("bush") if self.part else super().twin()

    def p_label(self) -> str:
        if not self.part:
            return super().p_label()
        suffix = SIDE_LABELS[self.side]
        return f"{super().p_label().removesuffix(suffix)}-Compliant-Joint{suffix}"

    def natural(self) -> Axes:
        return self.joint.ask("sides")[0] if self.joint else GLOBAL

    def p_numbers(self) -> dict[str, Any] | None:
        """Stiffness k [N/mm] and damping c [N s/mm] along its axes, kt and ct about them, preloads.

        kt [N mm/rad] and ct [N mm s/rad] are per radian. In MDL all three k come first, then c, kt and ct,
        then the forces and torques.
        """
        chosen = self.chosen("setbush", self.part)
        if chosen is None:
            return None
        arguments = chosen.statement.args[chosen.first :]
        return self.shared(chosen.scope, ("bush", arguments), lambda: self._read(chosen))

    def _read(self, chosen: Chosen) -> dict[str, Any]:
        laws = Laws(self.twin() if chosen.mirrored else self, chosen)
        found: dict[str, Any] = {}
        for group in GROUPS:
            found[group] = (laws.law(), laws.law(), laws.law())
        bent = {
            f"{GROUPS[k // 3]}.{k % 3}": dict(zip(("curve", "method", "variable"), law, strict=True))
            for k, law in enumerate(laws.curves)
            if law is not None
        }
        if bent:
            found["curves"] = bent
        found["force"] = (laws.number(), laws.number(), laws.number())
        found["torque"] = (laws.number(), laws.number(), laws.number())
        return found

    def record(self) -> dict[str, Any]:
        numbers = self.ask("numbers") or dict.fromkeys((*GROUPS, "force", "torque"))
        return {
            "label": self.ask("label"),
            "bodies": (self.ask("b1").name, self.ask("b2").name),
            "origin": self.start(),
            "axes": self.ask("axes"),
            **numbers,
        }


class CoilSpring(_Link):
    """`*CoilSpring( name, label, body_1, body_2, point_1, point_2 )`."""

    kind = "SpringDamper"

    def p_p1(self) -> Vector:
        return self.position(4)

    def p_p2(self) -> Vector:
        return self.position(5)

    def end(self) -> Vector:
        return self.position(5)

    def p_numbers(self) -> dict[str, Any] | None:
        """Stiffness, damping, and the force that it has at a length."""
        chosen = self.chosen("setcoilspring")
        if chosen is None:
            return None
        laws = Laws(self.twin() if chosen.mirrored else self, chosen)
        return {"k": laws.law(), "c": laws.law(), "force": laws.number(), "length": laws.number()}

    def record(self) -> dict[str, Any]:
        ends = (self.ask("p1"), self.ask("p2"))
        return {
            "label": self.ask("label"),
            "bodies": (self.ask("b1").name, self.ask("b2").name),
            "points": ends,
            "distance": math.hypot(*minus(*ends)),
            **(self.ask("numbers") or dict.fromkeys(("k", "c", "force", "length"))),
        }


class Force(_Link):
    """A force or torque between two bodies, or on one; its size where it is on one, along a marker's axes.

    `*ActionReactionForce( name, label, word, body_1, body_2, point, ... )` and
    `*ActionOnlyForce( name, label, word, body, point, marker )`. Where i and j are was read from a deck.
    """

    kind = "Force"

    def _both(self) -> bool:
        return self.declaration.kind == "ActionReactionForce"

    def _line_of_action(self) -> bool:
        return self._both() and self.statement.arg(2).upper() == "LOA"

    def p_b1(self) -> Any:
        return self.related(3, "Body")

    def p_b2(self) -> Any:
        return self.related(4, "Body") if self._both() else self.world.built_in("B_Ground")

    def start(self) -> Vector:
        return self.position(5 if self._both() else 4)

    def end(self) -> Vector:
        return self.position(6) if self._line_of_action() else self.start()

    def natural(self) -> Axes:
        if self._both() and self.statement.arg(6).upper() in ("VECTOR", "DXDYDZ"):
            return one_axis("Z", Directions(self, self.start(), self.statement, self.scope, 6).direction())
        return GLOBAL

    def p_jfloat(self) -> PartMarker:
        """The marker on the second body that moves with the first."""
        return self._part("jfloat", "Float Marker J", "b2", self.start)

    def p_reference(self) -> Any:
        """The marker along whose axes the components of a force on one body are."""
        if not self.statement.arg(5):
            return self.world.built_in("Global_Frame")
        return self.related(5, "Marker")

    def p_components(self) -> tuple[Components | None, Components | None]:
        """Force and torque along the global axes; where one is an expression all three are those along the
        marker's, as given."""
        chosen = self.chosen("setforce")
        word = self.statement.arg(2).upper()
        if chosen is None:
            return None, None
        laws = Laws(self, chosen)
        found: dict[str, Components | None] = {}
        for kind in ("TRANS", "ROT"):
            found[kind] = (0.0, 0.0, 0.0)
            if kind in word.split("_"):
                found[kind] = self._turned((laws.law(True), laws.law(True), laws.law(True)))
        return found["TRANS"], found["ROT"]

    def _turned(self, given: Components) -> Components:
        """Components along the global axes."""
        numbers = [v for v in given if isinstance(v, float)]
        if len(numbers) < 3:
            return given
        axes = self.world.frame(self.ask("reference"))[1]
        x, y, z = (sum(v * axis[k] for v, axis in zip(numbers, axes, strict=True)) for k in range(3))
        return x, y, z

    def record(self) -> dict[str, Any]:
        force, torque = self.ask("components")
        return {
            "label": self.ask("label"),
            "body": self.ask("b1").name,
            "origin": self.start(),
            "reference": self.ask("reference").name,
            "force": force or (None, None, None),
            "torque": torque or (None, None, None),
        }

    def markers(self) -> list[PartMarker]:
        found = super().markers()
        scalar = self._line_of_action() or self.statement.arg(2).upper().startswith("SC_")
        return found if scalar else [*found, self.ask("jfloat")]

    def marker_records(self) -> list[tuple[str, dict[str, Any]]]:
        return [(m.name, m.record()) for m in self.markers()]


class Output(_Link):
    """A request; by two points and bodies it has markers there, by an entity two unused ones on ground."""

    kind = "Output"

    def p_b1(self) -> Any:
        return self.related(4, "Body") if self._by_points() else self.world.built_in("B_Ground")

    def p_b2(self) -> Any:
        return self.related(6, "Body") if self._by_points() else self.world.built_in("B_Ground")

    def start(self) -> Vector:
        return self.position(3) if self._by_points() else (0.0, 0.0, 0.0)

    def end(self) -> Vector:
        return self.position(5) if self._by_points() else (0.0, 0.0, 0.0)

    def _by_points(self) -> bool:
        return self.statement.arg(2).upper() in ("DISP", "VEL", "ACCL") and len(self.statement.args) >= 7

    def p_expressions(self) -> tuple[str, ...] | None:
        """The six solver expressions, pasted; None for an output of another form."""
        if self.statement.arg(2).upper() != "EXPR":
            return None
        return tuple(str(self.given(3 + k)) for k in range(len(self.statement.args) - 3))

    def record(self) -> dict[str, Any]:
        return {"label": self.ask("label"), "expressions": self.ask("expressions")}

    def markers(self) -> list[PartMarker]:
        by_entity = self.statement.arg(2).upper() == "FORCE" and self.statement.arg(3).upper() == "FORCE"
        return super().markers() if self._by_points() or by_entity else []

    def marker_records(self) -> list[tuple[str, dict[str, Any]]]:
        return [(m.name, m.record()) for m in self.markers()]
