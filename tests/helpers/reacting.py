"""Scenes whose machine reacts, for tests: a sheet that falls along x past sensors."""

from __future__ import annotations

from typing import Any

import mdlgen
from mdlgen.model.tables import Model

MATERIAL = {"E_md": "3000 MPa", "E_cd": "1500 MPa", "D_md": "0.3 N*mm", "D_cd": "0.2 N*mm"}
NOTE = {"material": "p", "size": ["60 mm", "40 mm"], "thickness": "0.1 mm", "mass": "0.3 g"}


def falling(rules: list[dict[str, Any]], **more: Any) -> Model:
    """A note of one box, by default, that is accelerated along x by 2 m/s^2 from rest; `eye` sees its leading
    edge after 10 mm, `far` after 40 mm."""
    sheet = NOTE | {"boxes": [1, 1]} | more.pop("note", {})
    scene = {
        "name": "falls",
        "materials": {"p": MATERIAL},
        "sheets": {"note": sheet},
        "gravity": ["2 m/s^2", "0 m/s^2", "0 m/s^2"],
        "sensors": {
            "eye": {"beam": [["40 mm", "1 mm", "-5 mm"], ["40 mm", "1 mm", "5 mm"]]},
            "far": {"point": ["70 mm", "1 mm", "-2 mm"], "direction": "z"},
        },
        "rules": rules,
        "run": {"duration": "250 ms"},
    }
    return mdlgen.lower(mdlgen.Scene.model_validate(scene | more))


def wheel(rules: list[dict[str, Any]], **more: Any) -> Model:
    """The same note, and a driven roller that it does not touch."""
    drive = {"speed": "100 rad/s"}
    center = ["0 mm", "0 mm", "-30 mm"]
    own = {"center": center, "axis": "y", "radius": "5 mm", "width": "5 mm", "mass": "1 g", "drive": drive}
    return falling(rules, rollers={"w": own}, **more)
