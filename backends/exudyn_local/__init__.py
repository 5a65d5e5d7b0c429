"""The reference solver: Exudyn's bodies and integrators, with the force laws of `mdlgen.mechanics`.

All forces stand in one compiled function with its jacobian, so that every contact and bushing is the same
law that the oracles test, and any curve or share rule costs the same.
"""

from __future__ import annotations

from mdlgen.backends.exudyn_local.solve import solve

__all__ = ["solve"]
