"""Scenes with parts that move, and with stops, for templates."""

from __future__ import annotations

from template_basics import LINE, MESH, PLANE, PRESS, ROLLER, SOFT, put

PIVOT = {"at": ["-9 mm", "0 mm", "0 mm"], "axis": "y"}
PIVOT |= {"profile": [["1 ms", "0 deg"], ["2 ms", "20 deg"], ["4 ms", "-5 deg"]]}
WAY = {"direction": [0.6, 0, 0.8], "profile": [["0 ms", "0 mm"]]}


GATES = (
    put("guides", {"flap": {"line": LINE, "width": "30 mm", "pivot": PIVOT}}),
    put("planes", {"tilted": PLANE | {"normal": [0.6, 0, 0.8], "slide": WAY}}),
)


PIVOT_STOPS = {"low": "-4 deg", "high": "6 deg", "stiffness": "900 N*mm/rad"}


SLIDE_STOPS = {"low": "-1 mm", "high": "2 mm", "stiffness": "20 N/mm"}


FREE = {"at": ["-9 mm", "0 mm", "0 mm"], "axis": "y", "inertia": "500 g*mm^2", "stiffness": "3 N*mm/rad"}


HELD_FREE = FREE | {"stops": PIVOT_STOPS, "center": ["0 mm", "0 mm", "1 mm"]}


LOOSE = {"direction": [0.6, 0, 0.8], "mass": "7 g", "force": "1 N", "stops": SLIDE_STOPS}


STOPPED = put(
    "rollers",
    {
        "pressed": ROLLER | {"center": ["0 mm", "0 mm", "5 mm"], "press": PRESS | {"stops": SLIDE_STOPS}},
        "swung": ROLLER
        | {"arm": {"pivot": ["-30 mm", "0 mm", "-5 mm"], "mass": "8 g", "stops": PIVOT_STOPS}},
    },
)


FREE_GATES = (
    put("guides", {"flap": {"line": LINE, "width": "30 mm", "mass": "2 g", "pivot": HELD_FREE}}),
    put(
        "planes",
        {
            "door": PLANE | {"pivot": FREE},
            "floor": PLANE | {"slide": LOOSE},
            "lid": PLANE | {"press": SOFT | {"direction": "z", "stops": SLIDE_STOPS}},
        },
    ),
    put("meshes", {"loose": MESH | {"slide": LOOSE}, "wedge": MESH | {"pivot": FREE}}),
)
