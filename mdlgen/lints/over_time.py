"""Lints of what begins somewhere or changes over time: factors that do nothing, starts out of reach."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import Floats, Model


def factors(model: Model) -> Iterator[Lint]:
    """Factors that are 0 throughout a run, and corners that it does not reach."""
    for where, what, profile in _profiles(model):
        end = 0.0 if model.run.analysis == "static" else model.run.duration
        stations = np.append(profile[profile[:, 0] < end, 0], [0.0, end])
        if not np.interp(stations, profile[:, 0], profile[:, 1]).any():
            yield Lint(
                "W183",
                where,
                f"the factor of {what} is 0 throughout the run of {end:g} ms: it does nothing",
                "leave it out, or give corners that are not 0 within the run",
            )
        late = profile[profile[:, 0] > end]
        if len(late):
            yield Lint(
                "W184",
                where,
                f"the run ends at {end:g} ms, before {len(late)} of the {len(profile)} corners of {what}, "
                f"the last at {profile[-1, 0]:g} ms",
                "give a longer run.duration, or leave these corners out",
            )


def _profiles(model: Model) -> Iterator[tuple[str, str, Floats]]:
    if len(model.gravity_profile):
        yield "gravity_profile", "gravity", model.gravity_profile
    for entry in model.loads.changing:
        yield f"loads.{entry}.profile", f"load {entry}", model.loads.profiles[entry]


def far_start(model: Model) -> Iterator[Lint]:
    """Pressed rollers that begin where their spring has no length left, or deeper than a contact can be."""
    for roller in model.rollers:
        press = roller.press
        if press is None or press.begins is None:
            continue
        where = f"rollers.{roller.name}.press.start"
        if press.begins <= -press.free_length:
            yield Lint(
                "W185",
                where,
                f"{roller.name} begins {-press.begins:g} mm back, and its spring has a length of "
                f"{press.free_length:g} mm where it has its preload: none is left",
                f"give a free_length above {-press.begins:g} mm, or a start nearer to 0 mm",
            )
        elif press.begins >= 0.5 * roller.radius:
            yield Lint(
                "W185",
                where,
                f"{roller.name} begins {press.begins:g} mm beyond where it touches, more than half of its "
                f"radius of {roller.radius:g} mm: a run with a counterpart there ends at once",
                "give a start below that; a negative one lifts the roller",
            )
