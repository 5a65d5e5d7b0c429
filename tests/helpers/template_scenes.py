"""Scenes that show each template of a text with all of its branches."""

from __future__ import annotations

from template_basics import DRIVE, LINE, MESH, MOTOR, PLANE, PRESS, ROLLER, SOFT, TABLE
from template_basics import put as _put
from template_moving import FREE_GATES, GATES, STOPPED, WAY

PLATES = (
    'materials.paper.D_cd="0.24 N*mm"',
    'materials.paper.D_md="0.4 N*mm"',
    'materials.paper.D_twist="0.1 N*mm"',
    "materials.paper.k_tz=null",
)


C2C = "sheets.note.layout=center_to_center"


PLATE = "sheets.note.layout=plate"


GENERAL = 'sheets.note.rotation=["20 deg","-35 deg","110 deg"]'


MOVING = (
    'sheets.note.velocity=["1.5 m/s","0 m/s","-0.2 m/s"]',
    'sheets.note.spin=["3 rad/s","-7 rad/s","11 rad/s"]',
)


TURNED = ('sheets.note.turn="10 deg"',)


FLYING = (C2C, GENERAL, *MOVING, *PLATES, "sheets.note.boxes=[2,2]", "sheets.note.surface=true")


HELD = ("sheets.note.clamp={edge: x_max, length: 30 mm}", *MOVING)


HELD_Y = ("sheets.note.clamp={edge: y_min, length: 0 mm}", C2C, *PLATES)


# so nearly straight that few points do
CURVED = (
    "sheets.note.boxes=[2,2]",
    "sheets.note.clamp={edge: x_min, length: 0 mm}",
    _put("materials.paper.curve_md", [[0, "0 MPa"], [0.01, "35 MPa"], [0.02, "69.999 MPa"]]),
    _put(
        "materials.paper.curve_cd",
        {"points": [[0, "0 MPa"], [0.01, "11 MPa"], [0.02, "21.999 MPa"]], "extrapolate": "linear"},
    ),
)


BLOCK = ("sheets.note.boxes=[1,1]",)


ROLLERS = _put(
    "rollers",
    {
        "free": ROLLER,
        "driven": ROLLER | {"axis": "x", "drive": DRIVE},
        "ramped": ROLLER | {"axis": [0.6, 0.8, 0], "drive": DRIVE | {"ramp": "5 ms"}},
        "pressed": ROLLER | {"center": ["0 mm", "0 mm", "5 mm"], "press": PRESS},
        "toothed": ROLLER
        | {"radius": "1 mm", "rim": {"sectors": [{"from": "0 deg", "to": "90 deg", "radius": "1.1 mm"}]}},
        "swung": ROLLER | {"arm": {"pivot": ["-30 mm", "0 mm", "-5 mm"], "mass": "8 g", "torque": "60 N*mm"}},
        "held": ROLLER
        | {"axis": "x", "arm": {"pivot": ["0 mm", "9 mm", "0 mm"], "mass": "2 g", "inertia": "90 g*mm^2"}},
        "freed": ROLLER | {"one_way": {"direction": 1, "torque": "4 N*mm"}},
        "overrun": ROLLER
        | {
            "drive": DRIVE | {"ramp": "5 ms"},
            "one_way": {"direction": -1, "torque": "2 N*mm", "creep": "3 rad/s"},
        },
        "motor": ROLLER | {"drive": {"motor": MOTOR}, "bearing": {"torque": "1 N*mm"}},
        "table": ROLLER | {"drive": {"motor": TABLE}},
        "slips": ROLLER | {"limiter": {"torque": "6 N*mm"}, "drive": DRIVE},
        "retards": ROLLER | {"limiter": {"torque": "6 N*mm"}, "bearing": {"drag": "2 N*mm*ms/rad"}},
        "stopped": ROLLER | {"drive": {"profile": [["1 ms", "90 rad/s"], ["2 ms", "-9 rad/s"]]}},
    },
)


SHAFT = _put("shafts", {"main": {"rollers": {"under": 2}, "drive": DRIVE}})


PLANES = _put("planes", {"level": PLANE, "tilted": PLANE | {"normal": [0.6, 0, 0.8]}})


PLATES_ON_SPRINGS = _put(
    "planes",
    {
        "level": PLANE | {"press": SOFT | {"direction": "z"}},
        "tilted": PLANE
        | {"normal": [0.6, 0, 0.8], "press": SOFT | {"direction": [0, 0.6, 0.8], "carrier_mass": "2 g"}},
    },
)


ARC = {"center": ["0 mm", "0 mm", "20 mm"], "radius": "20 mm", "from": "-90 deg", "to": "-84 deg"}


GUIDES = _put(
    "guides",
    {
        "bend": {"arc": ARC | {"axis": "-y", "side": "inside"}, "width": "30 mm"},
        "lead": {"line": LINE, "width": "30 mm"},
        "round": {"arc": ARC | {"axis": "y", "side": "outside"}, "width": "30 mm"},
        "thin": {"line": LINE | {"side": "both"}, "width": "30 mm", "thickness": "0.2 mm"},
    },
)


MESHES = _put(
    "meshes",
    {
        "heavy": MESH | {"on": "driven", "density": "1.2 g/cm^3", "units": "cm"},
        "pushed": MESH | {"on": "pressed", "mass": "3 g"},
        "wedge": MESH | {"rotation": ["10 deg", "20 deg", "30 deg"]},
    },
)


SMOOTH, FINE = {"smoothing": "20 mm/s"}, {"smoothing": "1 mm/s"}


CONTACTS = (
    _put("rollers", {"under": ROLLER | {"drive": DRIVE}}),
    _put("planes", {"level": PLANE | {"center": ["0 mm", "0 mm", "-6 mm"]}}),
    _put(
        "contacts",
        [
            {"between": ["note", "under"], "stiffness": "300 N/mm^1.5", "friction": 0.9} | FINE,
            {"between": ["note", "level"], "friction": 0, "stiffness": "100 N/mm^1.5"} | SMOOTH,
        ],
    ),
)


PROBES = (
    "sheets.note.boxes=[2,2]",
    _put(
        "probes",
        {
            "corner": {"sheet": "note", "at": ["0 mm", "0 mm"]},
            "inside": {"sheet": "note", "at": ["12 mm", "-7 mm"]},
            "line": {"sheet": "note", "at": ["0 mm", "5 mm"]},
            "near": {"sheet": "note", "edge": "x_min"},
            "far": {"sheet": "note", "edge": "y_max"},
        },
    ),
)


SUPPORTS = (
    "sheets.note.boxes=[2,2]",
    _put(
        "supports",
        [
            {"sheet": "note", "at": ["12 mm", "-7 mm"], "fix": ["z"]},
            {"sheet": "note", "edge": "x_max", "fix": ["x", "y"]},
        ],
    ),
)


UNLIKE = (
    "sheets.note.boxes=[2,2]",
    "sheets.note.grading.y=[1,2]",
    _put("sheets.note.zones", {"stripe": {"x": ["0 mm", "10 mm"], "y": ["-5 mm", "5 mm"], "density": 2.0}}),
)


FOUR = "sheets.note.boxes=[2,2]"


CURLED = (FOUR, _put("sheets.note.shape", {"curl": {"radius": "80 mm", "along": "x"}}))


PUSHED_X = (FOUR, _put("sheets.note.shape", {"start": "flat", "curl": {"radius": "80 mm", "along": "x"}}))


PUSHED_Y = (FOUR, _put("sheets.note.shape", {"start": "flat", "curl": {"radius": "80 mm", "along": "y"}}))


FOLD = {"along": "y", "at": "0 mm", "angle": "30 deg", "stiffness": 0.5}


FOLDED = (FOUR, _put("sheets.note.shape", {"folds": [FOLD]}), *SUPPORTS[1:])


CLAMPED_BENT = ("sheets.note.clamp={edge: y_min, length: 0 mm}", *PUSHED_Y)


EAR = {"corner": ["x_max", "y_min"], "size": ["30 mm", "20 mm"], "angle": "60 deg"}


EARED = ("sheets.note.boxes=[3,3]", _put("sheets.note.shape", {"dog_ears": [EAR]}), *PROBES[1:])


PLAIN: tuple[str, ...] = ()


LOADS = (
    _put(
        "loads",
        [
            {"sheet": "note", "edge": "x_max", "force": ["1 N", "0 N", "-2 N"]},
            {"sheet": "note", "edge": "y_min", "moment": ["3 N*mm", "0 N*mm", "0 N*mm"]},
            {"sheet": "note", "edge": "x_min", "stress": "2 MPa"},
            {"sheet": "note", "at": ["0 mm", "-7 mm"], "force": ["0 N", "0 N", "-1 N"]},
        ],
    ),
    "sheets.note.boxes=[2,2]",
)


ONE_OF_EACH = (
    _put("rollers", {"under": ROLLER}),
    _put("planes", {"level": PLANE}),
    _put("guides", {"way": {"line": LINE, "width": "30 mm"}}),
    _put("meshes", {"wedge": MESH}),
    _put("contacts", [{"between": ["note", "under"], "stiffness": "300 N/mm^1.5", "friction": 0.9}]),
    _put("probes", {"lead": {"sheet": "note", "edge": "x_max"}}),
    _put("supports", [{"sheet": "note", "at": ["-30 mm", "0 mm"], "fix": ["z"]}]),
    _put("loads", [{"sheet": "note", "edge": "x_max", "stress": "1 MPa"}]),
)


PART = (
    _put("parts", {"feed": {"external": True, "body": "b_feed", "graphics": ["gra_feed", "gra_more"]}}),
    _put("contacts", [{"between": ["note", "feed"], "stiffness": "300 N/mm^1.5", "friction": 0.9}]),
    *ONE_OF_EACH[5:],
)


NAMED = (
    _put(
        "parameters", {"force": "3 N", "more": "force*1.5", "heavy": "0.5 g", "turned": "3 deg", "spare": 2}
    ),
    _put("rollers", {"under": ROLLER | {"mass": "heavy*2", "center": ["0 mm", "0 mm", "-(more/0.9 N/mm)"]}}),
    _put("sheets.note.turn", "asin(tan(turned))"),
    _put("sheets.note.mass", "max(heavy, 0.1 g) + abs(-heavy/4)"),
)


TILTED_GRAVITY = 'gravity=["1 m/s^2","0 m/s^2","-9.5 m/s^2"]'


WORDY = (*CONTACTS, "rollers.under.press={direction: z, stiffness: 0.3 N/mm, preload: 3 N}", TILTED_GRAVITY)


# For each template: what its sections show, and the scene that shows it.
FOLLOWING = (
    "parameters.force=3 N",
    'rollers={"upper": {"center": ["0 mm", "0 mm", "5 mm"], "axis": "y", "radius": "5 mm", "width": "8 mm", '
    '"mass": "0.5 g", "press": {"direction": "-z", "stiffness": "0.3 N/mm", "preload": "force"}}}',
    'contacts=[{"between": ["note", "upper"], "stiffness": "300 N/mm^1.5", "friction": 0}]',
)


PARTS: dict[str, dict[str, tuple[str, ...]]] = {
    "model.mdl.j2": {"one of each": (*ONE_OF_EACH, SHAFT), "parameters": (*NAMED, *BLOCK)},
    "parameters.mdl.j2": {"values, formulas, one that nothing uses": NAMED},
    "system.mdl.j2": {"for a part of another model": PART, "for none": BLOCK, "parameters": (*NAMED, *BLOCK)},
    "banner.mdl.j2": {
        "a sheet only": PLAIN,
        "curves": CURVED,
        "far from its plane": (*WORDY, 'planes.level.center=["0 mm","0 mm","-90 mm"]', *MOVING),
    },
    "sheet_data.mdl.j2": {
        "hinges, edge to edge, tiled": PLAIN,
        "plates, centre to centre, paper's grid, in motion": (
            *(C2C, *PLATES, *MOVING, GENERAL),
            *("sheets.note.boxes=[2,2]", "sheets.note.grid=paper"),
        ),
        "curves": CURVED,
        "bending guessed": ("materials.paper.k_tx=null", "materials.paper.k_ty=null"),
        "the paper's damping": ("materials.paper.damping.rotation=paper",),
        "a damping time": ("materials.paper.damping={time: 0.1 ms}",),
        "loss factors of MD and CD, twist": (
            *(C2C, *PLATES, 'materials.paper.damping={loss_factor: [0.05, 0.02], at: "40 Hz"}'),
        ),
        "damping times of MD and CD, a plate with lengths of their own": (
            *(PLATE, *UNLIKE, 'materials.paper.damping={time: ["0.1 ms", "0.3 ms"]}'),
        ),
        "the paper's damping, twist": (C2C, *PLATES, "materials.paper.damping.rotation=paper"),
        "a plate": (PLATE,),
        "a plate in full, the paper's damping": (
            *(PLATE, *PLATES, "materials.paper.G=700 MPa", "materials.paper.damping.rotation=paper"),
        ),
        "a block": BLOCK,
        "lengths of their own, a zone": UNLIKE,
        "curled": CURLED,
        "folded": FOLDED,
        "a dog-ear": EARED,
    },
    "sheet.mdl.j2": {
        "lengths of their own, a zone": UNLIKE,
        "curled": CURLED,
        "folded": FOLDED,
        "a dog-ear": EARED,
        "flat, pushed to a curl along x": PUSHED_X,
        "flat, pushed to a curl along y, held": CLAMPED_BENT,
        "aligned, edge to edge": PLAIN,
        "turned": TURNED,
        "general rotation, in motion, twist, surface, centre to centre": FLYING,
        "held beyond a line across x, in motion": HELD,
        "held at an edge along x, twist": HELD_Y,
        "a plate, held at an edge along x": (*HELD_Y, PLATE),
        "curves, held at an edge": CURVED,
        "a block": BLOCK,
    },
    "support.mdl.j2": {"in a box, on an edge between two": SUPPORTS},
    "load.mdl.j2": {
        "over time": (
            *LOADS,
            "loads.0.profile=[[0 ms,0],[5 ms,1],[9 ms,-0.5]]",
            "loads.2.profile=[[0 ms,0],[5 ms,1]]",
        ),
        "on edges and at points": LOADS,
        "on an edge with lengths of its own": (*UNLIKE, *LOADS[:1]),
    },
    "roller.mdl.j2": {
        "each kind": (ROLLERS,),
        "with a spin": (ONE_OF_EACH[0], "rollers.under.spin=10 rad/s"),
        "with stops": (STOPPED,),
        "on a shaft": (_put("rollers", {"under": ROLLER}), SHAFT),
    },
    "plane.mdl.j2": {
        "level, with a normal of its own": (PLANES,),
        "pressed": (PLATES_ON_SPRINGS,),
        "on a slide": GATES[1:],
        "freely": FREE_GATES[1:2],
    },
    "guide.mdl.j2": {"straight and bent": (GUIDES,), "by a profile": GATES[:1], "freely": FREE_GATES[:1]},
    "mesh.mdl.j2": {
        "fixed, on a driven roller, on a pressed one": (ROLLERS, MESHES),
        "on a slide": (_put("meshes", {"wedge": MESH | {"slide": WAY}}),),
        "freely": FREE_GATES[2:],
    },
    "contacts.mdl.j2": {
        "a zone with its own friction": (*CONTACTS, *UNLIKE, "sheets.note.zones.stripe.friction=2"),
        "with and without friction": CONTACTS,
        "a start that follows": FOLLOWING,
        "none": PLAIN,
    },
    "probe.mdl.j2": {"on one, two and four boxes, on edges": PROBES},
    "force.mdl.j2": {"of a contact, in parts": (*CONTACTS, "sheets.note.boxes=[3,4]", "run.prune=false")},
    "run.mdl.j2": {
        "transient": PLAIN,
        "static": ("run.analysis=static",),
        "contacts, with and without friction": CONTACTS,
        "a zone with its own friction": (*CONTACTS, *UNLIKE, "sheets.note.zones.stripe.friction=2"),
    },
    "companion.py.j2": {
        "contacts": CONTACTS,
        "contacts of a system": PART,
        "contacts that follow": (*CONTACTS, "parameters.k=250 N/mm^1.5", "contacts.0.stiffness=k"),
    },
}
