"""Motions, contacts, couplers and solver variables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mdlgen.backends.motionview.reader.things.thing import Thing

_FORCES = {
    "POISSON": ("penalty", "restitution"),
    "IMPACT": ("stiffness", "exponent", "damping", "dmax"),
}
_FRICTION = ("mu_static", "mu_dynamic", "stiction_velocity", "friction_velocity")


class Motion(Thing):
    """`*Motion( name, label, JOINT, joint, ROT|TRANS )`."""

    kind = "Motion"

    def p_joint(self) -> Any:
        return self.related(3 if self.statement.arg(2).upper() == "JOINT" else 2, "Joint")

    def p_law(self) -> tuple[str, str, Any] | None:
        """DISP, VEL or ACCL; LIN, EXPR and so on; the number or the solver expression."""
        chosen = self.chosen("setmotion")
        if chosen is None:
            return None
        statement, first = chosen.statement, chosen.first
        words = (statement.arg(first).upper(), statement.arg(first + 1).upper())
        if words[1] in ("LIN", "EXPR"):
            return (*words, self.given(first + 2, statement, chosen.scope))
        return (*words, ", ".join(statement.args[first + 2 :]))

    def record(self) -> dict[str, Any]:
        law = self.ask("law") or (None, None, None)
        return {
            "label": self.ask("label"),
            "joint": self.ask("joint").name,
            "freedom": self.statement.args[-1].upper(),
            "quantity": law[0],
            "type": law[1],
            "value": law[2],
        }


def flip_step(args: Sequence[str], at: int) -> int:
    """Arguments of each graphic of a side that begins at `at`: 2 with a word for flipped normals, as in 2021,
    1 without, as the help of 2025 has it."""
    return 2 if at + 4 < len(args) and args[at + 4].lower() in ("true", "false") else 1


class ContactThing(Thing):
    """`*Contact( name, label, force, friction, BODY, b1, n, graphic, flip, ..., BODY, b2, ... )`."""

    kind = "Contact"

    def p_sides(self) -> list[tuple[Any, list[Any]]]:
        """Both bodies, each with its graphics."""
        found = []
        at, args = 4, self.statement.args
        while at < len(args) and args[at].upper() == "BODY":
            body = self.related(at + 1, "Body")
            count = int(self.number(at + 2))
            step = flip_step(args, at)
            graphics = [
                self.related(at + 3 + step * k, "Graphic")
                for k in range(count)
                if at + 3 + step * k < len(args)
            ]
            found.append((body, graphics))
            at += 3 + step * count
        return found

    def _flips(self) -> tuple[str, ...]:
        """The words after the graphics, which flip their normals."""
        words = (a.lower() for a in self.statement.args[4:])
        return tuple(word for word in words if word in ("true", "false"))

    def p_numbers(self) -> dict[str, float]:
        """Values of *SetContact, by the documented order."""
        chosen = self.chosen("setcontact")
        if chosen is None:
            return {}
        names = _FORCES.get(self.statement.arg(2).upper(), ())
        if self.statement.arg(3).upper() != "OFF":
            names += _FRICTION
        found = {}
        for k, name in enumerate(names):
            if chosen.first + k < len(chosen.statement.args):
                found[name] = self.number(chosen.first + k, chosen.statement, chosen.scope)
        return found

    def _attachments(self) -> dict[str, tuple[str, ...]]:
        """The arguments of its system among bodies and graphics, by the names that they have inside."""
        found = tuple(a for a in self.statement.args[4:] if a in self.scope.parameters)
        return {"attachments": found} if found else {}

    def record(self) -> dict[str, Any]:
        sides = self.ask("sides")
        return {
            "label": self.ask("label"),
            "type": self.statement.arg(2).upper(),
            "friction": self.statement.arg(3).upper(),
            "bodies": tuple(body.name for body, _ in sides),
            "graphics": tuple(tuple(g.name for g in graphics) for _, graphics in sides),
            "flips": self._flips(),
            **self._attachments(),
            **self.ask("numbers"),
        }


class Coupler(Thing):
    """`*Coupler( name, label, 2JOINT, joint_1, joint_2, ... )`."""

    kind = "Coupler"

    def p_ratio(self) -> float:
        """The factor of *SetCoupler."""
        chosen = self.chosen("setcoupler")
        return 0.0 if chosen is None else self.number(chosen.first, chosen.statement, chosen.scope)


class SolverVariable(Thing):
    """`*SolverVariable( name, label )`."""

    kind = "SolverVariable"

    def p_varval(self) -> str:
        """The solver function that reads it."""
        return f"VARVAL({self.name})"
