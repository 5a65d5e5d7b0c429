"""The parameters that the user gave for loads."""

from __future__ import annotations

from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.tables import Parameter
from mdlgen.spec.scene import Scene


def load_rows(scene: Scene) -> list[Parameter]:
    """All rows, entry by entry."""
    rows = []
    for index, load in enumerate(scene.loads):
        name, base = f"load_{index}", ("loads", index)
        for k, axis in enumerate(NAMED_AXES[:2]):
            if load.at is not None:
                label = f"{axis} from the centre of the sheet"
                rows.append(Parameter(name, axis, label, load.at[k], "mm", (*base, "at", k)))
        if load.stress is not None:
            label = "Tension along the outward normal (N/mm2)"
            rows.append(Parameter(name, "stress", label, load.stress, "MPa", (*base, "stress")))
        for word, letter, unit, given in (
            ("force", "f", "N", load.force),
            ("moment", "m", "N*mm", load.moment),
        ):
            for k, axis in enumerate(NAMED_AXES):
                if given is not None:
                    way = "along" if word == "force" else "about"
                    label = f"{word.capitalize()} {way} {axis} of the sheet ({unit.replace('*', ' ')})"
                    row = Parameter(name, f"{letter}_{axis}", label, given[k], unit, (*base, word, k))
                    rows.append(row)
        for k, (time, factor) in enumerate(load.profile or ()):
            path = (*base, "profile", k)
            rows.append(Parameter(name, f"t_{k}", f"Time of corner {k}", time, "ms", (*path, 0)))
            rows.append(Parameter(name, f"c_{k}", f"Factor at corner {k}", factor, "1", (*path, 1)))
    return rows
