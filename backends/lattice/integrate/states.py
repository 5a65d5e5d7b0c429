"""Places and velocities of all bodies at the times that a run stores.

There is one array of each from the start, which the result takes without a copy: for a pile of a hundred
sheets they are most of the memory of a run. Rotations are stored as Euler parameters, computed for several
states at a time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.kernels.tuning import TOGETHER
from mdlgen.mechanics.frame import Motion
from mdlgen.model.meshes import carried
from mdlgen.model.rotations import euler_parameters
from mdlgen.model.tables import Floats, Model

WIDTHS = {"x": 3, "u": 3, "w": 3, "e": 4}


class States:
    """Places x [mm], velocities u, w [mm/ms, rad/ms] and Euler parameters e at `count` times."""

    def __init__(self, model: Model, mirror, room: int):
        """`mirror`: places the bodies that symmetry eliminates, None: none are; `room`: expected number of
        times, which may be exceeded."""
        self._model, self._mirror = model, mirror
        bodies = len(model.bodies.name)
        self._arrays: dict[str, Floats] = {k: np.empty((room, bodies, n)) for k, n in WIDTHS.items()}
        self.count = 0
        # number of complete states, and the rotations (bodies, 9) of the others; in one tuple, since another
        # thread may read it
        self._ready: tuple[int, list[np.ndarray]] = (0, [])

    def add(self, motion: Motion, there: NDArray[np.bool_] | None = None) -> None:
        """Stores a state; all sheets are there."""
        whole, turned = self._ready
        x = self._arrays["x"]
        if self.count == len(x):
            more = max(8, self.count)
            blank = {name: np.empty((more, *array.shape[1:])) for name, array in self._arrays.items()}
            self._arrays = {name: np.concatenate([a, blank[name]]) for name, a in self._arrays.items()}
        bodies = x.shape[1]
        for name, array in (("x", motion.x), ("u", motion.u), ("w", motion.w)):
            self._arrays[name][self.count] = array[:bodies]
        turned.append(motion.r[:bodies].copy())
        self.count += 1
        if len(turned) * bodies >= TOGETHER:
            self._complete()

    def _complete(self) -> None:
        """Completes all states that are stored but not yet complete."""
        whole, turned = self._ready
        if turned:
            self._fill({name: array[whole : self.count] for name, array in self._arrays.items()}, turned)
            self._ready = (self.count, [])

    def _fill(self, states: dict[str, Floats], turned: list[np.ndarray]) -> None:
        """Fills in the bodies that are not solved for, and Euler parameters: nan where rotations are not
        finite."""
        r = np.array(turned)
        if self._mirror is not None:
            self._mirror.fill(states["x"], r, states["u"], states["w"])
        carried(self._model, states["x"], r, states["u"], states["w"])
        states["e"][:] = np.nan
        if np.isfinite(r).all():
            states["e"][:] = euler_parameters(r.reshape(*r.shape[:2], 3, 3))

    def all(self) -> dict[str, Floats]:
        """The arrays of all states, (times, bodies, width), which are these themselves."""
        self._complete()
        found = {name: array[: self.count] for name, array in self._arrays.items()}
        return found | {"e": without_jumps(found["e"])}

    def first(self, times: int) -> dict[str, Floats]:
        """Copies of the arrays of the first states; the run may continue meanwhile."""
        (whole, turned), arrays = self._ready, self._arrays
        found = {name: array[:times].copy() for name, array in arrays.items()}
        if times > whole:
            self._fill({name: array[whole:] for name, array in found.items()}, turned[: times - whole])
        return found | {"e": without_jumps(found["e"])}

    def kept(self) -> dict[str, Floats]:
        """All arrays, for a checkpoint."""
        return self.all()

    def restore(self, arrays: dict[str, Floats]) -> None:
        """Restores the state that `kept` returned."""
        self.count = len(arrays["x"])
        room = max(self.count, len(self._arrays["x"]))
        for name in WIDTHS:
            array = arrays[name]
            self._arrays[name] = np.empty((room, *array.shape[1:]))
            self._arrays[name][: self.count] = array
        self._ready = (self.count, [])


def without_jumps(parameters: np.ndarray) -> np.ndarray:
    """Euler parameters (t, bodies, 4), in place, with signs for which they are continuous from state to
    state; nan for all where some are not finite."""
    if not np.isfinite(parameters).all():
        return np.full_like(parameters, np.nan)
    signs = np.sign(np.einsum("tbi,tbi->tb", parameters[1:], parameters[:-1]))
    signs[signs == 0] = 1.0
    parameters[1:] *= np.cumprod(signs, axis=0)[:, :, None]
    return parameters
