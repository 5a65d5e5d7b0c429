"""A scene of a campaign. Its seed and its number alone determine it."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mdlgen import paths
from mdlgen.bench.campaign.draw import Data, Draw
from mdlgen.bench.campaign.kinds import KINDS
from mdlgen.errors import MdlgenError

if TYPE_CHECKING:
    from mdlgen.model.tables import Model

# A scene that the spec rejects is drawn again so often.
TRIES = 20


@dataclass(frozen=True)
class DrawnScene:
    """A scene as text, with the mesh files that it names."""

    seed: int
    number: int
    kind: str
    text: str  # YAML
    files: dict[str, str] = field(default_factory=dict)  # path from the scene's folder -> text
    rejected: tuple[str, ...] = ()  # why earlier draws of it were rejected

    @property
    def name(self) -> str:
        return f"{self.kind}_{self.seed}_{self.number}"

    def write(self, folder: Path) -> Path:
        """The files of the scene, for `mdlgen run`. Raises OutputError."""
        for name, text in self.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            paths.write_atomic(folder / name, text)
        paths.write_atomic(folder / f"{self.name}.yaml", self.text)
        return folder / f"{self.name}.yaml"

    def model(self, overrides: Iterable[str] = ()) -> Model:
        """The scene, lowered; `overrides` as of `--set`. Raises SpecError."""
        from mdlgen.model.lower import lower
        from mdlgen.spec.load import loads

        if not self.files:
            return lower(loads(self.text, self.name, overrides))
        with tempfile.TemporaryDirectory() as folder:
            file = self.write(Path(folder))
            return lower(loads(self.text, self.name, overrides, file.parent))


def drawn(seed: int, number: int, kind: str = "", sticking: bool = False) -> DrawnScene:
    """The scene of that number, of a kind that is drawn where it is not given; one that the spec rejects is
    drawn again. `sticking`: the same scene with friction that sticks in every second contact. Raises
    SpecError where all of TRIES draws are rejected."""
    rejected: list[str] = []
    while True:
        scene = _once(seed, number, kind, sticking, tuple(rejected))
        try:
            scene.model()
        except MdlgenError as error:
            rejected.append(f"{scene.kind}: {error}")
            if len(rejected) == TRIES:
                raise
            continue
        return scene


def _once(seed: int, number: int, kind: str, sticking: bool, rejected: tuple[str, ...]) -> DrawnScene:
    """Draws a scene. Each repeated draw has its own random numbers."""
    from mdlgen.spec.source import text_of_data

    own = list(KINDS).index(kind) + 1 if kind else 0
    draw = Draw([seed, number, len(rejected), own])
    kind = kind or list(KINDS)[draw.weighted([share for share, _ in KINDS.values()])]
    made = dict(KINDS[kind][1](draw))
    if sticking:
        _stick(draw, made)
    name = f"{kind}_{seed}_{number}"
    files = {_own(path, name): text for path, text in made.pop("files", {}).items()}
    for mesh in made.get("meshes", {}).values():
        mesh["file"] = _own(mesh["file"], name)
    data: Data = {"name": name, **{key: made[key] for key in ORDER if key in made}}
    return DrawnScene(seed, number, kind, text_of_data(data), files, rejected)


def _stick(draw: Draw, made: Data) -> None:
    """Gives the friction of every second contact, from the first on, a stiffness along the faces."""
    for contact in list(_with_friction(made))[::2]:
        mu = contact["friction"]
        both = mu if isinstance(mu, dict) else {"static": mu, "dynamic": mu}
        contact["friction"] = {**both, "sticking": draw.text("sticking")}


def _with_friction(node: Any) -> Iterator[Data]:
    """The entries that have a friction: contacts, and those of nips and piles. A sector
    of a rim has factors."""
    if isinstance(node, dict) and "friction" in node and isinstance(node.get("stiffness"), str):
        yield node
    for item in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
        yield from _with_friction(item)


def _own(path: str, name: str) -> str:
    """The name of a mesh file that several scenes may have in one folder."""
    head, _, suffix = path.rpartition(".")
    return f"{head.rpartition('/')[0]}/{name}.{suffix}"


# Keys of a scene in the order in which they are written.
ORDER = (
    *("materials", "sheets", "piles", "nips", "rollers", "planes", "guides", "meshes", "contacts", "run"),
)
