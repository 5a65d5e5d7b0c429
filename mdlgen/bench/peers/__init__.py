"""Other tools on the same scene: MuJoCo's flex sheet, and a script for Exudyn's own items.

Each is a solver of one module, as the backends are, and runs in a child process as they do.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import metadata
from importlib.util import find_spec

from mdlgen.bench.case import Run

PEERS = {"mujoco": "mdlgen.bench.peers.mujoco_flex", "exudyn-script": "mdlgen.bench.peers.exudyn_script"}
# Steps [ms] at which each is run.
STEPS = {"mujoco": (0.25, 0.125, 0.05, 0.025), "exudyn-script": (0.1, 0.05)}
# Sheet of each peer; the case's name.
SHEETS = {"mujoco": "isotropic flex of 11 x 21 nodes", "exudyn-script": "10 x 20 boxes, by hand"}
MISSING = (
    "MuJoCo is not installed: pip install 'mdlgen[peers]' adds it and an Exudyn script to the comparison"
)


def installed() -> bool:
    """True if the extra `peers` is installed."""
    return find_spec("mujoco") is not None


def versions() -> dict[str, str]:
    """Version of MuJoCo, where it is installed; Exudyn's is among ours."""
    return {"mujoco": metadata.version("mujoco")} if installed() else {}


@dataclass(frozen=True)
class PeerRun(Run):
    """A run that only the bench can repeat."""

    quick: bool = False

    def command(self, solver: str) -> str:
        return f"mdlgen bench transport --solver {solver}" + " --quick" * self.quick
