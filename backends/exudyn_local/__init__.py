"""The reference solver: Exudyn's bodies and integrators, with the force laws of `mdlgen.mechanics`.

One compiled function evaluates all forces and their jacobian. So contacts and bushings use the laws that the
tests check, and any curve or share rule costs the same.
"""

from __future__ import annotations

from mdlgen.backend import Backend, Shipped
from mdlgen.backends.exudyn_local.solve import solve

__all__ = ["BACKEND", "solve"]
_SHORT = ("run.duration=0.4 ms", "run.print_step=0.2 ms", "run.step=0.1 ms")
_FEW = ("sheets.note.boxes=[2, 3]",)
BACKEND = Backend(
    solve=solve,
    shipped=Shipped(
        "mdlgen.backends.exudyn_local.shipped",
        (
            ("transport_4x4.yaml", _SHORT),
            ("pick.yaml", _SHORT),
            ("landing.yaml", _SHORT),
            ("cantilever.yaml", _FEW),
            ("verify/tension.yaml", ()),
            ("crease.yaml", (*_SHORT, "sheets.strip.boxes=[4, 2]")),
        ),
    ),
)
