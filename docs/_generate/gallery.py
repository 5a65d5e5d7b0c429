"""A picture of each sample, with what its own comment says."""

from __future__ import annotations

import re
from pathlib import Path

from markdown import NOTE

ROOT = Path(__file__).resolve().parent.parent.parent
SAMPLES = ROOT / "samples"
PICTURES = ROOT / "docs" / "pictures" / "samples"
GROUPS = {
    "Transport of a note": (
        *("transport_4x4", "transport_nips", "transport_4x2", "transport_tilted"),
        *("tilt_correction", "rubber_nip"),
    ),
    "Machines that react": ("recycler", "register", "sorter", "duplex"),
    "Channels and guides": ("channel", "guide_joint", "diverter"),
    "Stacks and feeders": (
        *("stack", "pile", "landing", "spring_plate", "retard_pad", "feeder_window", "feeder", "feeder_one"),
        *("peel", "pick", "retard", "stall", "stream"),
    ),
    "Material": ("cantilever", "saddle", "snatch", "crease"),
    "Closed forms": tuple(f"verify/{n}" for n in ("drop", "slide", "aslant", "incline", "spun", "tension")),
    "Closed forms, bent and turned": tuple(f"verify/{n}" for n in ("hanging", "rollup", "flip")),
}
HEAD = f"""{NOTE}# Gallery

Every sample of mdlgen, with a picture of its run. `mdlgen new DIR --from NAME` copies one into a folder of
yours; `mdlgen new --list` lists them. Colours show the speed of each box, in a scene at rest the curvature.

"""


def names() -> list[str]:
    """Of all samples, as `mdlgen new --from` takes them."""
    return sorted(p.relative_to(SAMPLES).with_suffix("").as_posix() for p in SAMPLES.rglob("*.yaml"))


def page() -> str:
    """gallery/index.md. Raises ValueError for a sample that stands in no group, or in two."""
    shown = [name for group in GROUPS.values() for name in group]
    if sorted(shown) != names():
        raise ValueError(f"samples in no group, or gone: {set(shown) ^ set(names())}")
    return HEAD + "\n".join(
        f"## {title}\n\n" + "\n".join(_sample(name) for name in group) for title, group in GROUPS.items()
    )


def _sample(name: str) -> str:
    picture = f"../pictures/samples/{name.replace('/', '_')}.png"
    return f"### {name}\n\n![{name}]({picture})\n\n{comment(name)}\n\n    mdlgen run samples/{name}.yaml\n"


def comment(name: str) -> str:
    """The first paragraph of a sample's comment, as Markdown."""
    lines = (SAMPLES / f"{name}.yaml").read_text("utf-8").splitlines()
    said: list[str] = []
    for line in lines:
        if not line.startswith("#") or not line.strip("# "):
            break
        said.append(line.removeprefix("#").strip())
    text = " ".join(said).replace("*", "\\*").replace("<", "&lt;")
    return re.sub(r" (Shows:?)", r"\n\n\1", text, count=1)
