"""The files of a run: all of them are written, or the old ones stay."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.errors import OutputError
from mdlgen.paths import check_folder, recover, write_together
from mdlgen.results.estimates import complete
from mdlgen.results.io import tree
from mdlgen.results.io.series import csv
from mdlgen.results.result import ContactStatistics, Result
from mdlgen.results.strain import sheet_joints
from mdlgen.results.summary import summary, versions

if TYPE_CHECKING:
    from mdlgen.model.tables import Model

UNITS = "mm, N, g, ms, rad"
STATES = ("time", "position", "rotation", "velocity", "spin", "contact_force")
# which files of older versions do not have, or those of scenes in which nothing yields, or without motors, or
# in which no sheet comes in or leaves
TURNS = ("contact_torque", "contact_friction", "plastic", "behind", "stays")
# fields of a Result, apart from its states, that the tables of the file hold
STORED = (
    "model", "solver", "status", "touched", "energy", "step", "steps", "rounds", "halved", "error_estimate",
    "error_estimate_of", "error_below", "error_unknown", "search_ended", "chaotic", "doubts", "estimates",
    "versions", "source", "reactions",
)  # fmt: skip
TOOK = ("wall_s", "estimate_s", "build_s", "compile_s")  # which differ from run to run
STATISTICS = ("max_depth", "mean_depth", "max_force", "mean_force", "last_force_at")


def save(result: Result, folder: Path, also: Mapping[str, bytes] | None = None) -> dict[str, Any]:
    """Write summary.json, series.csv and result.h5 into `folder`, and the files `also` (name -> bytes).
    Returns what summary.json holds.

    A run that ended early leaves what there is up to then, and says so in its status; a run before it in the
    folder is replaced. Raises OutputError, and leaves what was there, where a file cannot be written; and for
    a failed run without a state, as a static one is.
    """
    if not len(result.time):
        raise OutputError(f"{folder}: nothing written, there is no state: {result.status}")
    message = summary(result)
    files: dict[Path, str | bytes] = {
        folder / "summary.json": json.dumps(message, indent=2, allow_nan=False) + "\n",
        folder / "series.csv": csv(result),
        folder / "result.h5": hdf5(result),
    }
    for name in also or {}:
        if Path(name).name != name:
            raise OutputError(f"{name!r}: is not the name of a file in {folder}")
    files |= {folder / name: content for name, content in (also or {}).items()}
    check_folder(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make this folder: {error.strerror or error}") from None
    write_together(files)
    return message


def prepare(model: Model) -> None:
    """Loads the modules for the files, and computes all that does not depend on the run."""
    import h5py  # noqa: F401

    from mdlgen.results import events  # noqa: F401

    sheet_joints(model)


def hdf5(result: Result) -> bytes:
    """result.h5: states and statistics in the Model's units, with the names of bodies and contact rows, what
    the joints of the sheets bore at most (`joints/...`; see `results.strain`), and the Model (`model/...`).

    The same result gives the same bytes: no times of writing are stored; `took` and `ran_at` alone
    have those of the run.
    """
    import h5py

    model = result.model
    complete(result)
    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        put = tree.Writer(file).put
        for name in STATES:
            put(name, getattr(result, name))
        for name in TURNS:
            if getattr(result, name) is not None:
                put(name, getattr(result, name))
        for name in STATISTICS:
            put(f"statistics/{name}", np.asarray(getattr(result.statistics, name), dtype=float))
        for name, data in _joints(result).items():
            put(f"joints/{name}", data)
        tree.put(file, {name: getattr(result, name) for name in STORED} | {"versions": versions(result)})
        put("took", np.array([getattr(result, name) for name in TOOK]))
        put("ran_at", np.bytes_(result.ran_at.encode("ascii")))
        put("bodies", _names(model.bodies.name))
        put("contacts", _names(_rows(result)))
        for name, value in (
            ("scene", model.name),
            ("solver", result.solver),
            ("status", result.status),
            ("units", UNITS),
        ):
            file.attrs[name] = value
    return stream.getvalue()


def load(folder: str | Path) -> Result:
    """The Result that was saved into `folder`, from its result.h5 alone. Raises OutputError."""
    import h5py

    path = Path(folder) / "result.h5"
    if not path.exists():
        raise OutputError(f"{path}: there is no such file; mdlgen run SPEC -o {folder} writes it")
    try:
        with h5py.File(path, "r") as opened:
            file: Any = opened
            if "model" not in file:
                raise OutputError(f"{path}: holds states and no model; it is of an older mdlgen, run again")
            message = tree.take(file) | dict(zip(TOOK, file["took"][()].tolist(), strict=True))
            states = {name: file[name][()] for name in (*STATES, *TURNS) if name not in TURNS or name in file}
            if "ran_at" in file:  # which files of older versions do not have
                message["ran_at"] = bytes(file["ran_at"][()]).decode("ascii")
            statistics = ContactStatistics(**{name: file[f"statistics/{name}"][()] for name in STATISTICS})
            return Result(**message, **states, statistics=statistics)
    except (OSError, KeyError, TypeError, ValueError, AttributeError) as error:
        reason = (str(error).splitlines() or [""])[0]
        raise OutputError(f"{path}: cannot read: {reason}") from None


def read(folder: str | Path) -> dict[str, Any]:
    """The arrays of a saved result.h5 by name (`statistics/max_depth` ...), and its attributes as text.

    `bodies`, `contacts` ("a / b") and `joints/name` are lists of names; the Model is left out (`load` has
    it). Raises OutputError.
    """
    import h5py

    path = Path(folder) / "result.h5"
    recover(Path(folder))
    found: dict[str, Any] = {}
    try:
        with h5py.File(path, "r") as file:

            def take(name: str, item: Any) -> None:
                if isinstance(item, h5py.Dataset) and not name.startswith("model/"):
                    found[name] = item[()]

            file.visititems(take)
            for name in ("bodies", "contacts", *(["joints/name"] if "joints/name" in found else [])):
                found[name] = [value.decode("ascii") for value in found[name]]
            found |= {str(name): str(value) for name, value in file.attrs.items()}
    except (OSError, KeyError, UnicodeDecodeError) as error:
        raise OutputError(f"{path}: cannot read: {str(error).splitlines()[0]}") from None
    return found


def _joints(result: Result) -> dict[str, Any]:
    """Names and places of the joints, and the peak of each over the stored times with its time."""
    strains = result.strains
    if strains is None:
        return {}
    joints = strains.joints
    columns: dict[str, Any] = {
        "name": _names(joints.name),
        "sheet": joints.sheet,
        "axis": joints.axis,
        "at": joints.at,
        "length": joints.length,
    }
    for name, peak in (
        ("strain_max", strains.stretch),
        ("strain_min", strains.squeeze),
        ("curvature", strains.curvature),
        ("twist", strains.twist),
    ):
        columns |= {name: peak.value, f"{name}_at": peak.at}
    return columns if strains.margin is None else {**columns, "margin": strains.margin}


def _rows(result: Result) -> list[str]:
    contacts = result.model.contacts
    return [f"{a} / {b}" for a, b in zip(contacts.part_a, contacts.part_b, strict=True)]


def _names(names: Any) -> np.ndarray:
    """Fixed-length bytes: variable-length strings would not be stored the same twice."""
    return np.array([str(n).encode("ascii") for n in names], dtype=f"S{max(map(len, names), default=1)}")
