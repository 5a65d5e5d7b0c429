"""Paper sheets in machines: a scene is written once and lowered once; every backend reads the same tables.

    scene  = mdlgen.load("samples/transport_4x4.yaml")
    model  = mdlgen.lower(scene)
    text   = mdlgen.emit(model, "motionview")
    result = mdlgen.solve(model, "exudyn")
    result.save("out/")

Inside, one set of units holds: mm, N, g, ms, rad. All errors derive from `mdlgen.errors.MdlgenError`.
Importing this package costs nothing: each part is imported when it is first used.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.compare import Comparison
    from mdlgen.results.result import Result
    from mdlgen.spec.scene import Scene

__all__ = ["Model", "Result", "Scene", "compare", "emit", "load", "loads", "lower", "solve"]

CLASSES = {
    "Arc": "mdlgen.spec.guide",
    "Arm": "mdlgen.spec.machine",
    "Bearing": "mdlgen.spec.motor",
    "Clamp": "mdlgen.spec.sheet",
    "Contact": "mdlgen.spec.contact",
    "Control": "mdlgen.spec.motor",
    "Curl": "mdlgen.spec.shape",
    "Curve": "mdlgen.spec.curve",
    "Damping": "mdlgen.spec.material",
    "DogEar": "mdlgen.spec.shape",
    "Drive": "mdlgen.spec.machine",
    "Fold": "mdlgen.spec.shape",
    "Friction": "mdlgen.spec.friction",
    "Graded": "mdlgen.spec.grading",
    "Grading": "mdlgen.spec.grading",
    "Guide": "mdlgen.spec.guide",
    "Limiter": "mdlgen.spec.motor",
    "Line": "mdlgen.spec.guide",
    "Load": "mdlgen.spec.action",
    "Material": "mdlgen.spec.material",
    "Mesh": "mdlgen.spec.mesh",
    "Mirror": "mdlgen.spec.rows",
    "Model": "mdlgen.model.tables",
    "Motor": "mdlgen.spec.motor",
    "Nip": "mdlgen.spec.nip",
    "OneWay": "mdlgen.spec.machine",
    "Part": "mdlgen.spec.part",
    "Plane": "mdlgen.spec.machine",
    "Press": "mdlgen.spec.machine",
    "Probe": "mdlgen.spec.action",
    "Repeat": "mdlgen.spec.rows",
    "Result": "mdlgen.results.result",
    "Rim": "mdlgen.spec.rim",
    "Roller": "mdlgen.spec.machine",
    "Run": "mdlgen.spec.run",
    "Scene": "mdlgen.spec.scene",
    "Sector": "mdlgen.spec.rim",
    "Shaft": "mdlgen.spec.shaft",
    "Shape": "mdlgen.spec.shape",
    "Sheet": "mdlgen.spec.sheet",
    "Steps": "mdlgen.spec.motor",
    "Support": "mdlgen.spec.action",
    "Zone": "mdlgen.spec.zone",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from mdlgen.version import version

        return version()
    if name in CLASSES:
        from importlib import import_module

        return getattr(import_module(CLASSES[name]), name)
    raise AttributeError(f"module 'mdlgen' has no attribute {name!r}")


def load(path: str | Path, overrides: Iterable[str] = ()) -> Scene:
    """The scene of a YAML or JSON file; `overrides` are texts like `sheets.note.boxes=[20,30]`.

    Raises SpecError with file:line:column for what cannot be meant, OutputError for a file that cannot be
    read.
    """
    from mdlgen.spec import load as loader

    return loader.load(path, overrides)


def loads(text: str, overrides: Iterable[str] = (), folder: str | Path | None = None) -> Scene:
    """The scene of a YAML or JSON text; as `load`. Files that it names are looked for in `folder`,
    without one not at all. Raises SpecError."""
    from pathlib import Path

    from mdlgen.spec import load as loader

    return loader.loads(text, overrides=overrides, folder=None if folder is None else Path(folder))


def lower(scene: Scene) -> Model:
    """The plain tables that every backend reads (mm, N, g, ms, rad). Raises SpecError."""
    from mdlgen.model import lower as room

    return room.lower(scene)


def emit(model: Model, backend: str = "motionview") -> str:
    """The Model as text of another program.

    Raises SpecError for a backend that there is not, RefusedError for what it cannot represent.
    """
    from mdlgen import registry

    return registry.emitter(backend).emit(model)


def solve(
    model: Model,
    solver: str = "auto",
    progress: Callable[[float, float, int, int], None] | None = None,
    check_step: bool = False,
) -> Result:
    """Run a Model. A run that fails returns a Result whose `status` is the reason.

    `progress(time, end, steps, touching)` is called during the run (times in ms, pairs that touch).
    `check_step` runs again at half the step and returns the finer result, with `error_estimate` in the norm
    of `run.tolerance`. Raises SpecError for an unknown solver, RefusedError for a Model that the solver
    cannot represent.
    """
    from mdlgen import registry

    return registry.solve(model, solver, progress, check_step)


def compare(result: Result, other: Result) -> Comparison:
    """How far `other` is from `result`: positions [mm], travel [mm], nip forces (relative).

    Raises SpecError where the two are not of the same boxes, or share no time.
    """
    from mdlgen.results import compare as room

    return room.compare(result, other)
