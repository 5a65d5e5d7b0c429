"""Points, vectors and markers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdlgen.backends.motionview.reader.things.orientation import axes
from mdlgen.backends.motionview.reader.things.thing import SIDE_LABELS, Thing
from mdlgen.backends.motionview.reader.things.vectors import GLOBAL, Axes
from mdlgen.backends.motionview.reader.world import Frame, Vector

if TYPE_CHECKING:
    from collections.abc import Callable


class _Triple(Thing):
    """Three numbers of a Set statement; each is found by itself, since one may need another."""

    complete = True
    setter = ""
    symmetric = False

    def _coordinate(self, index: int) -> float:
        chosen = self.chosen(self.setter, symmetric=self.symmetric)
        if chosen is None:
            if not self.memo.get("unset"):
                self.memo["unset"] = True
                message = f"{self} is never set; it counts as 0, 0, 0"
                self.world.notes.add("warning", "unset", self.statement.place(), message)
            return 0.0
        at = chosen.first + index
        if self.side == "r" and chosen.first == 2 and not chosen.mirrored and not chosen.statement.arg(1):
            at += 3  # the right half of a statement for both sides
        source = self.twin() if chosen.mirrored else self
        value = source.number(at, chosen.statement, chosen.scope)
        return -value + 0.0 if chosen.mirrored and index == 1 else value

    def p_x(self) -> float:
        return self._coordinate(0)

    def p_y(self) -> float:
        return self._coordinate(1)

    def p_z(self) -> float:
        return self._coordinate(2)

    def p_data(self) -> Vector:
        """The three numbers."""
        return (self.ask("x"), self.ask("y"), self.ask("z"))


class Point(_Triple):
    """A place [mm]. The left one of a pair defines both, also where both are set (seen in a deck)."""

    kind = "Point"
    setter = "setpoint"
    symmetric = True


class VectorThing(_Triple):
    """A direction; of any length, as it is given."""

    kind = "Vector"
    setter = "setvector"


class Marker(Thing):
    """A place with axes on a body: `*Marker( name, label, body, point )`."""

    kind = "Marker"
    complete = True
    part = ""

    def p_origin(self) -> Vector:
        return self.position(3)

    def p_body(self) -> Any:
        return self.related(2, "Body")

    def p_axes(self) -> Axes:
        """X, Y and Z in global coordinates."""
        chosen = self.chosen("setorientation", self.part)
        if chosen is None:
            return self.natural()
        origin = self.ask("origin")
        return axes(self, self.twin().ask("origin") if chosen.mirrored else origin, origin, chosen)

    def natural(self) -> Axes:
        """The axes where none are set."""
        return GLOBAL

    def p_frame(self) -> Frame:
        return (self.ask("origin"), self.ask("axes"))

    def p_xaxis(self) -> Vector:
        return self.ask("axes")[0]

    def p_yaxis(self) -> Vector:
        return self.ask("axes")[1]

    def p_zaxis(self) -> Vector:
        return self.ask("axes")[2]

    def p_x(self) -> float:
        return self.ask("origin")[0]

    def p_y(self) -> float:
        return self.ask("origin")[1]

    def p_z(self) -> float:
        return self.ask("origin")[2]

    def record(self) -> dict[str, Any]:
        body = self.ask("body")
        return {
            "label": self.ask("label"),
            "body": body.name if body is not None else None,
            "origin": self.ask("origin"),
            "axes": self.ask("axes"),
        }


NO_PART = "-"  # a part that nothing sets: the axes come from the owner


class PartMarker(Marker):
    """A marker that MotionView makes for an entity: the cm of a body, i and j of a joint or a bushing."""

    def __init__(
        self,
        owner: Thing,
        word: str,
        title: str,
        body: Callable[[], Any],
        origin: Callable[[], Vector],
        natural: Callable[[], Axes] = lambda: GLOBAL,
        part: str | None = None,
    ):
        super().__init__(owner.world, owner.declaration, owner.side)
        self.owner = owner
        self.word = word
        self.title = title
        self.part = word if part is None else part
        self._body = body
        self._origin = origin
        self._natural = natural
        self.call(f"{owner.base}.{word}")

    def twin(self) -> Thing:
        return self.owner.twin().ask(self.word)

    def p_label(self) -> str:
        label = self.owner.ask("label")
        suffix = SIDE_LABELS[self.side]
        return f"{label.removesuffix(suffix)}-{self.title}{suffix}"

    def p_origin(self) -> Vector:
        return self._origin()

    def p_body(self) -> Any:
        return self._body()

    def natural(self) -> Axes:
        return self._natural()


class GlobalPoint(Thing):
    """P_Global_Origin."""

    kind = "Point"
    complete = True

    def p_x(self) -> float:
        return 0.0

    p_y = p_z = p_x

    def p_data(self) -> Vector:
        return (0.0, 0.0, 0.0)


class GlobalVector(Thing):
    """V_Global_X, V_Global_Y and V_Global_Z."""

    kind = "Vector"
    complete = True

    def p_data(self) -> Vector:
        return GLOBAL["xyz".index(self.declaration.slot.name[-1].lower())]

    def p_x(self) -> float:
        return self.p_data()[0]

    def p_y(self) -> float:
        return self.p_data()[1]

    def p_z(self) -> float:
        return self.p_data()[2]


class GlobalFrame(Marker):
    """Global_Frame: on ground, at the origin, along the global axes."""

    def p_label(self) -> str:
        return "Global Frame"

    def p_origin(self) -> Vector:
        return (0.0, 0.0, 0.0)

    def p_body(self) -> Any:
        return self.world.built_in("B_Ground")
