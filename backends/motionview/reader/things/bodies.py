"""Bodies: mass, inertia and centre of mass, as given or from the solids of their graphics."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.geometry import NO_PART, PartMarker
from mdlgen.backends.motionview.reader.things.orientation import axes
from mdlgen.backends.motionview.reader.things.solids import Mass, total
from mdlgen.backends.motionview.reader.things.thing import SIDE_LABELS, Chosen, Thing
from mdlgen.backends.motionview.reader.things.vectors import GLOBAL, Axes
from mdlgen.backends.motionview.reader.world import Vector

INERTIA = ("ixx", "iyy", "izz", "ixy", "iyz", "ixz")
_RATES = ("vx", "vy", "vz", "wx", "wy", "wz")


class Body(Thing):
    """`*Body( name, label, cm_point, im_point, lprf_point, ... )`."""

    kind = "Body"

    def p_numbers(self) -> tuple[float, ...] | None:
        """Mass [kg], then Ixx, Iyy, Izz, Ixy, Ixz, Iyz [kg mm2] as given; None where they are not."""
        settings = [
            (setting.rank, k, kind)
            for kind in ("setbodyinertia", "setbody")
            for k, setting in enumerate(self.settings(kind))
        ]
        if not settings:
            return None
        chosen = self.chosen(max(settings)[2])
        if chosen is None:
            return None
        arguments = chosen.statement.args[chosen.first :]
        return self.shared(chosen.scope, ("body", chosen.mirrored, arguments), lambda: self._read(chosen))

    def _read(self, chosen: Chosen) -> tuple[float, ...]:
        source = self.twin() if chosen.mirrored else self
        m, x, y, z, xy, xz, yz = (
            source.number(chosen.first + k, chosen.statement, chosen.scope) for k in range(7)
        )
        if chosen.mirrored:  # a mirrored frame stays right-handed, so products with Y change sign
            xy, yz = -xy + 0.0, -yz + 0.0
        return (m, x, y, z, xy, xz, yz)

    def p_from_graphics(self) -> bool:
        return self.flag("inertia_props_from_graphic")

    def p_properties(self) -> Mass | None:
        """Mass, inertia about the centre of mass, and that centre; None for a body without."""
        if self.ask("from_graphics"):
            return total(part for g in self.world.graphics_of(self) if (part := g.ask("solid")) is not None)
        numbers = self.ask("numbers")
        if numbers is None:
            return None
        m, x, y, z, xy, xz, yz = numbers
        return Mass(m, self._cm_point(), (x, y, z, xy, yz, xz))

    def _property(self) -> Mass:
        found = self.ask("properties")
        if found is None:
            raise Trouble("unset", f"{self} has no mass")
        return found

    def p_mass(self) -> float:
        return self._property().mass

    def p_cm(self) -> PartMarker:
        """The marker at the centre-of-mass point, with the axes of the inertia."""
        return PartMarker(
            self, "cm", "Marker CM", lambda: self, self._cm_point, lambda: self.ask("cm_axes"), NO_PART
        )

    p_cg = p_cm

    def p_im(self) -> PartMarker:
        if self.statement.arg(3):
            return PartMarker(self, "im", "Marker IM", lambda: self, lambda: self.position(3))
        return self.ask("cm")

    def p_lprf(self) -> PartMarker:
        """Marker at the origin of the body's coordinates: the global origin unless a point is given."""
        return PartMarker(self, "lprf", "Marker LPRF", lambda: self, self._reference)

    def p_geomprops(self) -> PartMarker:
        """The centre of mass of the graphics."""
        return PartMarker(
            self, "geomprops.cm", "Inertia Props-Marker CM", lambda: self, lambda: self._property().center
        )

    def attribute(self, key: str, name: str, shift: int) -> Any:
        if key in INERTIA:
            return self._property().inertia[INERTIA.index(key)]
        if key in _RATES:
            return self.rate(_RATES.index(key))
        return super().attribute(key, name, shift)

    def rate(self, index: int) -> float:
        """An initial velocity [mm/s, rad/s], 0 where none is given."""
        return self.world.demand(self, "rate" + str(index))

    def compute(self, key: str) -> Any:
        if key.startswith("rate"):
            chosen = self.chosen("setbodyic")
            if chosen is None:
                return 0.0
            return self.number(chosen.first + int(key[4:]), chosen.statement, chosen.scope)
        return super().compute(key)

    def markers(self) -> list[PartMarker]:
        """Markers of the body in the deck."""
        found = [self.ask("lprf"), self.ask("cm")]
        if self.ask("from_graphics"):
            found.append(self.ask("geomprops"))
        return found

    def marker_records(self) -> list[tuple[str, dict[str, Any]]]:
        if self.ask("from_graphics"):
            return super().marker_records()
        label, tail = self.ask("label"), f".{self.side}" if self.side else ""
        suffix = SIDE_LABELS[self.side]
        label = label.removesuffix(suffix)
        axes = self.ask("cm_axes")
        return [
            (
                f"{self.base}.{word}{tail}",
                {
                    "label": f"{label}-Marker {word.upper()}{suffix}",
                    "body": self.name,
                    "origin": place,
                    "axes": own,
                },
            )
            for word, place, own in (("lprf", self._reference(), GLOBAL), ("cm", self._cm_point(), axes))
        ]

    def p_cm_axes(self) -> Axes:
        """Axes of the centre-of-mass marker, which its inertia is about."""
        chosen = self.chosen("setorientation", "cm")
        if chosen is None:
            return GLOBAL
        origin = self._cm_point()
        twin = self.twin() if chosen.mirrored else self
        return axes(self, twin._cm_point() if isinstance(twin, Body) else origin, origin, chosen)

    def record(self) -> dict[str, Any]:
        found: Mass | None = self.ask("properties")
        record: dict[str, Any] = {"label": self.ask("label")}
        if found is None:
            record |= {"mass": None, "inertia": None, "cm": self._cm_point()}
        else:
            record |= {"mass": found.mass, "inertia": found.inertia, "cm": found.center}
        record["axes"] = GLOBAL if self.ask("from_graphics") else self.ask("cm_axes")
        frames, flags = self.statement.args[5:7], self.chosen("setbodyicflag")
        if self.statement.arg(3):
            record["im"] = self.position(3)
        if any(frames):
            record["velocity_frames"] = frames
        if flags is not None:
            record["velocity_flags"] = flags.statement.args[flags.first :]
        return record

    def p_velocity(self) -> tuple[float, ...] | None:
        """Initial vx, vy, vz [mm/s] and wx, wy, wz [rad/s]; None where nothing is given."""
        return tuple(self.rate(k) for k in range(6)) if self.settings("setbodyic") else None

    def _cm_point(self) -> Vector:
        return self.position(2) if self.statement.arg(2) else (0.0, 0.0, 0.0)

    def _reference(self) -> Vector:
        return self.position(4) if self.statement.arg(4) else (0.0, 0.0, 0.0)


class Ground(Body):
    """B_Ground."""

    def p_label(self) -> str:
        return "Ground Body"

    def _cm_point(self) -> Vector:
        return (0.0, 0.0, 0.0)

    _reference = _cm_point
