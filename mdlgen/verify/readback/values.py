"""Values that were read from a text or a deck, as the tables of `expected`."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mdlgen.altair.recorded import whole
from mdlgen.verify.expected.clutches import SPINS, clutch_times
from mdlgen.verify.expected.contacts import CONTACT_NUMBERS, SIX
from mdlgen.verify.expected.loads import load_times
from mdlgen.verify.expected.run import RUN_NUMBERS
from mdlgen.verify.expected.times import OF_AXLES, OF_STOPS, longest
from mdlgen.verify.readback.graphics import graphic_tables, surface_table
from mdlgen.verify.readback.rows import Row, flat, table_of
from mdlgen.verify.solver_expressions import Places, Unreadable, law, of_joint, request, torques
from mdlgen.verify.tables import Table

Values = Mapping[str, Mapping[str, Any]]

_NAN = float("nan")
_LOAD = re.compile(r"frc_\d+")
_CLUTCH, _AXLE, _STOPS = (re.compile(rf"frc_(\w+)_{word}") for word in ("clutch", "axle", "stops"))
_MEASURED = re.compile(r"(?:[DV]|[AW])Z\(([^()]*)\)")
_CONTACT = re.compile(r"^\s*CONTACT\(|\)\s*$|\s")
_MARKER = re.compile(r"[A-Za-z_][\w.]*(?=\s*[,)])")
_CONTACT_ATTRIBUTES = {
    "penalty": "penalty",
    "restitution_coeff": "restitution",
    "normal_trans_vel": "normal_trans_vel",
    "mu_static": "mu_static",
    "mu_dynamic": "mu_dynamic",
    "stiction_trans_vel": "stiction_velocity",
    "friction_trans_vel": "friction_velocity",
}
# Attributes of the commands that control a run: attribute -> its name here.
_RUN_ATTRIBUTES = {
    "Simulate": {"analysis_type": "analysis", "end_time": "end", "print_interval": "print"},
    "Param_Transient": {
        "integrator_type": "integrator",
        "integr_tol": "tol",
        "h_max": "h_max",
        "h_min": "h_min",
    },
    "Param_Static": {"method": "method"},
}


class ReadBack:
    """Tables of some values; `stations` are the times [s] at which the laws of drives are evaluated."""

    def __init__(self, stations: Mapping[str, tuple[float, ...]], markers: Mapping[str, Any] | None = None):
        self.stations = stations
        self.markers = markers or {}
        self.places = Places(self.markers)

    def tables(self, values: Values) -> dict[str, Table]:
        """All kinds that `expected` has, but for data sets, contacts, gravity and run settings."""
        of_bodies = {
            f"{name}.cm": {"body": name, "origin": record["cm"], "axes": record["axes"]}
            for name, record in values.get("bodies", {}).items()
        }
        of_bushings = {
            f"{name}.{end}": {"body": body, "origin": record["origin"], "axes": record["axes"]}
            for name, record in values.get("bushings", {}).items()
            if record.get("curves")
            for end, body in zip("ij", record["bodies"], strict=True)
        }
        self.places = Places(self.markers, values.get("markers", {}), of_bodies, of_bushings)
        return {
            "points": table_of(values.get("points", {}), lambda n, r: (list(r), ()), 3),
            "bodies": table_of(values.get("bodies", {}), _body, 19),
            "bushings": table_of(values.get("bushings", {}), _bushing, 30),
            "curves": table_of(_curve_points(values.get("curves", {})), lambda n, r: (list(r), ()), 2),
            "curve laws": table_of(_curve_laws(values.get("bushings", {})), self._curve_law, 1),
            "springs": table_of(values.get("springs", {}), _spring, 10),
            **graphic_tables(values.get("graphics", {})),
            "joints": table_of(values.get("joints", {}), _joint, 6),
            "motions": table_of(values.get("motions", {}), self._motion, longest(self.stations)),
            "clutches": table_of(
                _spun(values, _CLUTCH), self._clutch, 3 + len(clutch_times(self.stations, "")) * len(SPINS)
            ),
            "axles": table_of(_spun(values, _AXLE), self._axle, 3 + len(self._points(OF_AXLES, "")) // 2),
            "stops": table_of(_spun(values, _STOPS), self._stop, 3 + len(self._points(OF_STOPS, "")) // 2),
            "velocities": table_of(values.get("velocities", {}), lambda n, r: (list(r), ()), 6),
            "markers": table_of(
                {n: r for n, r in values.get("markers", {}).items() if "." not in n}, _marker, 12
            ),
            "vectors": table_of(values.get("vectors", {}), _vector, 3),
            "surfaces": surface_table(values.get("surfaces", {})),
            "outputs": table_of(
                {n: r for n, r in values.get("outputs", {}).items() if not _of_contacts(r)}, self._output, 6
            ),
            "loads": table_of(
                {n: r for n, r in values.get("forces", {}).items() if _LOAD.fullmatch(n)},
                self._load,
                3 + 6 * len(load_times(self.stations)),
            ),
        }

    def _motion(self, name: str, record: Mapping[str, Any]) -> Row:
        words = (record["joint"] or "", record["freedom"] or "", record["quantity"] or "")
        # of one that nobody knows any time will do
        times = self.stations.get(name, next(iter(self.stations.values()), ()))
        speeds = [self._law(record, t) for t in times]
        return speeds, words

    @staticmethod
    def _law(record: Mapping[str, Any], time: float) -> float:
        if record["type"] == "LIN":
            return float(record["value"])
        try:
            return law(str(record["value"]), time)
        except Unreadable:
            return _NAN

    def _clutch(self, name: str, record: Mapping[str, Any]) -> Row:
        times = clutch_times(self.stations, _part(_CLUTCH, name))
        points = [(t, w) for t in times for w in SPINS]
        *idle, about = record["components"]
        return self._over(record, about, lambda: torques(about, points), idle)

    def _axle(self, name: str, record: Mapping[str, Any]) -> Row:
        points = self._points(OF_AXLES, _part(_AXLE, name))
        *idle, about = record["components"]
        return self._over(record, about, lambda: torques(about, _pairs(points)), idle)

    def _stop(self, name: str, record: Mapping[str, Any]) -> Row:
        points, six = self._points(OF_STOPS, _part(_STOPS, name)), list(record["components"])
        turns = six[2] == "0"
        acts = six.pop(5 if turns else 2)
        words = ["torque" if turns else "force"] if six == ["0"] * 5 else six
        return self._over(record, acts, lambda: of_joint(acts, _pairs(points)), words)

    def _points(self, kind: str, part: str) -> tuple[float, ...]:
        """Pairs of numbers of a part, one after the other; of one that nobody knows those of another one."""
        own = [points for name, points in self.stations.items() if name.startswith(kind)]
        return self.stations.get(f"{kind}{part}", own[0] if own else ())

    def _over(
        self, record: Mapping[str, Any], text: str, values: Callable[[], list[float]], words: Sequence[str]
    ) -> Row:
        """Axis of a force over a joint, and its values; what it is on and follows from, and other words."""
        # a marker of a joint is called joint_i in texts and decks, i in scripts
        calls = {re.sub(r"\s|joint_", "", call) for call in _MEASURED.findall(text)}
        said = (record["body"], *sorted(calls), *words)
        try:
            return [*self.places[record["reference"]].axes[2].tolist(), *values()], said
        except Unreadable:
            return [], said

    def _load(self, name: str, record: Mapping[str, Any]) -> Row:
        """Place of a load, its forces at all times of loads, and its moments."""
        found = [*record["origin"]]
        for word in ("force", "torque"):
            for time in load_times(self.stations):
                found += self._components(record["reference"], record[word], time)
        return found, (record["body"],)

    def _components(self, reference: str, given: Sequence[Any], time: float) -> list[float]:
        """Along the global axes at a time [s]; as given where all three are numbers. Those of expressions are
        along the axes of a marker."""
        if not any(isinstance(value, str) for value in given):
            return list(given)
        try:
            numbers = [law(value, time) if isinstance(value, str) else float(value) for value in given]
            return (np.array(numbers) @ self.places[reference].axes).tolist()
        except Unreadable:
            return [_NAN] * 3

    def _curve_law(self, name: str, record: Mapping[str, str]) -> Row:
        variable = record["variable"]
        # in the made-up state no axes turn: it does not show along which ones a displacement is
        return [self._request(variable)], (record["curve"], record["method"], *_MARKER.findall(variable))

    def _output(self, name: str, record: Mapping[str, Any]) -> Row:
        return [self._request(text) for text in record["expressions"] or ()], ()

    def _request(self, text: str) -> float:
        try:
            return request(text, self.places)
        except Unreadable:
            return _NAN


def _body(name: str, record: Mapping[str, Any]) -> Row:
    inertia = record["inertia"] or [_NAN] * 6
    mass = record["mass"] if record["mass"] is not None else _NAN
    return [mass, *inertia, *record["cm"], *flat(record["axes"])], ()


def _bushing(name: str, record: Mapping[str, Any]) -> Row:
    groups: dict[str, list[Any]] = {
        g: list(record[g] or (None,) * 3) for g in ("k", "c", "kt", "ct", "force", "torque")
    }
    for place in record.get("curves", {}):  # compared among the curve laws
        group, k = place.split(".")
        if isinstance(groups[group][int(k)], str):
            groups[group][int(k)] = 0.0
    return [*record["origin"], *flat(record["axes"]), *flat(groups.values())], tuple(record["bodies"])


def _curve_points(records: Mapping[str, Any]) -> dict[str, tuple[float, float]]:
    return {
        f"{name}.{k}": point
        for name, record in records.items()
        for k, point in enumerate(zip(record["x"] or (), record["y"] or (), strict=True))
    }


def _curve_laws(records: Mapping[str, Any]) -> dict[str, Mapping[str, str]]:
    return {f"{n}.{place}": law for n, r in records.items() for place, law in r.get("curves", {}).items()}


def _spun(values: Values, named: re.Pattern[str]) -> dict[str, dict[str, Any]]:
    """Body, reference marker and six components, as expressions, of each torque that follows from a spin; a
    script lists them apart."""
    found: dict[str, dict[str, Any]] = {}
    for name, record in values.get("clutches", {}).items():
        if named.fullmatch(name):
            body, _, reference = record["ends"]
            components = (*record["force"], *record["torque"])
            found[name] = {"body": body, "reference": reference, "components": [_text(v) for v in components]}
    for name, record in values.get("forces", {}).items():
        if named.fullmatch(name):
            components = (*record["force"], *record["torque"])
            found[name] = record | {"components": [_text(v) for v in components]}
    return found


def _part(named: re.Pattern[str], name: str) -> str:
    return named.sub(r"\1", name)


def _pairs(numbers: Sequence[float]) -> list[tuple[float, float]]:
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def _text(component: Any) -> str:
    return f"{component:g}" if isinstance(component, float) else str(component)


def _spring(name: str, record: Mapping[str, Any]) -> Row:
    numbers = [*flat(record["points"]), *(record[k] for k in ("k", "c", "force", "length"))]
    return numbers, tuple(record["bodies"])


def _joint(name: str, record: Mapping[str, Any]) -> Row:
    axis = record["axis"] if record["axis"] is not None else (0.0, 0.0, 0.0)
    return [*record["origin"], *axis], (record["type"], *record["bodies"])


def _marker(name: str, record: Mapping[str, Any]) -> Row:
    return [*record["origin"], *flat(record["axes"])], (record["body"] or "",)


def _vector(name: str, record: Any) -> Row:
    length = float(np.linalg.norm(record))
    return [v / length if length else _NAN for v in record], ()


def marker_table(values: Values, reach: float = 0.0) -> Table:
    """All markers, those too that belong to bodies, joints and bushings; `reach` is the size of the scene.

    Left out are those that MotionView makes for a load on ground, which nothing uses.
    """
    unused = {f"{name}.{end}" for name in values.get("forces", {}) for end in ("j", "jfloat")}
    found = table_of({n: r for n, r in values.get("markers", {}).items() if n not in unused}, _marker, 12)
    return replace(found, scale=np.broadcast_to([reach] * 3 + [1.0] * 9, found.numbers.shape))


def data_table(values: Values) -> Table:
    """Numbers of all data sets."""
    found = {
        f"{holder}.{member}": value
        for holder, members in values.get("datasets", {}).items()
        for member, value in members.items()
    }
    return table_of(found, lambda n, value: ([value], ()), 1)


def contact_table(values: Values, numbers: Mapping[str, Mapping[str, float]]) -> Table:
    """Contacts with the numbers of the text; `numbers` are those that a script gives, by contact."""

    def row(name: str, record: Mapping[str, Any]) -> Row:
        all_numbers = {**record, **numbers.get(name, {})}
        missing = 0.0 if record["friction"] == "OFF" else _NAN
        found = [
            all_numbers.get(n, missing if "mu_" in n or "velocity" in n else _NAN) for n in CONTACT_NUMBERS
        ]
        graphics = [g for side in record["graphics"] for g in side]
        named = [name.removeprefix("MODEL.") for name in (*record["bodies"], *graphics)]
        return found, (record["type"], record["friction"], *named)

    return table_of(values.get("contacts", {}), row, len(CONTACT_NUMBERS))


def commanded(values: Values) -> dict[str, dict[str, float]]:
    """Numbers that solver commands give contacts, by contact."""
    found: dict[str, dict[str, float]] = {}
    for command in (c for commands in values.get("commands", {}).values() for c in commands):
        if command["command"] == "Force_Contact":
            given = {
                own: _float(command[name]) for name, own in _CONTACT_ATTRIBUTES.items() if name in command
            }
            found.setdefault(command.get("id", ""), {}).update(given)
    return found


def master_table(values: Values) -> Table:
    """The master side of each contact, of a deck or of the solver commands of an MDL file."""
    sides = {name: record.get("master", "") for name, record in values.get("contacts", {}).items()}
    for command in (c for commands in values.get("commands", {}).values() for c in commands):
        if command["command"] == "Force_Contact":
            sides[command.get("id", "")] = command.get("master_surface", "")
    return table_of(sides, lambda n, side: ([], (side,)), 0)


def contact_outputs_of(values: Values) -> dict[str, list[list[tuple[str, ...]]]]:
    """The outputs of an MDL file that record contacts: for each component the terms, as contact, side,
    component and frame."""
    found: dict[str, list[list[tuple[str, ...]]]] = {}
    for name, record in values.get("outputs", {}).items():
        if not _of_contacts(record):
            continue
        part = whole(str(record["label"]))
        all_parts = found.setdefault(
            name if part is None else name.removesuffix(f"_part{part[1]}"),
            [[] for _ in record["expressions"]],
        )
        for terms, text in zip(all_parts, record["expressions"], strict=True):
            terms += [tuple(_CONTACT.sub("", term).split(",")) for term in text.split("+")]
    return found


def _of_contacts(record: Mapping[str, Any]) -> bool:
    return any(text.startswith("CONTACT(") for text in record["expressions"] or ())


def contact_output_table(values: Values) -> Table:
    """Recorded components of contacts: contact, side, component and frame of each term."""
    recorded = {**contact_outputs_of(values), **values.get("contact outputs", {})}
    found = {
        f"{name}.{key}": tuple(sorted(" ".join(term) for term in terms))
        for name, components in recorded.items()
        for key, terms in zip(SIX, components, strict=True)
    }
    return table_of(found, lambda n, words: ([], words), 0)


def run_table(values: Values) -> Table:
    """Analysis, times and steps of a deck, or of the solver commands that a text's template writes."""
    settings: dict[str, Any] = {}
    if "run" in values:
        settings = dict(values["run"])
    elif not values.get("templates"):
        return table_of({}, lambda n, r: ([], ()), len(RUN_NUMBERS))
    else:
        for command in (c for commands in values["commands"].values() for c in commands):
            named = _RUN_ATTRIBUTES.get(command["command"], {})
            settings |= {own: command[name] for name, own in named.items() if name in command}
    static = settings.get("analysis") == "Static"
    words = (str(settings.get("analysis")), str(settings.get("method" if static else "integrator")))
    missing = "0" if static else None
    numbers = [_float(settings.get(name, missing)) for name in RUN_NUMBERS]
    if static:  # takes no steps
        numbers[1:] = [0.0] * (len(RUN_NUMBERS) - 1)
    return table_of({"run": None}, lambda n, r: (numbers, words), len(RUN_NUMBERS))


def gravity_of(values: Values) -> tuple[float, float, float]:
    """Gravity of a text [mm/s^2]; nan where nothing says it."""
    given = values.get("standard", {}).get("gravity", {})
    if given.get("op_gravity", "On") == "Off":
        return 0.0, 0.0, 0.0
    x, y, z = (_float(given.get(name)) for name in ("igrav", "jgrav", "kgrav"))
    return x, y, z


def units_table(values: Values) -> Table:
    """Units of a deck, or of a text."""
    given = values.get("standard", {}).get("units", {})
    words = tuple(str(given.get(f"op_{name}")) for name in ("force", "length", "mass", "time"))
    return table_of({"units": None}, lambda n, r: ([], words), 0)


def gravity_table(gravity: Any) -> Table:
    """Gravity [mm/s^2]."""
    return table_of({"gravity": gravity}, lambda n, r: (list(r), ()), 3)


def _float(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return _NAN
