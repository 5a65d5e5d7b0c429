"""The result of a run in the Model's units: mm, N, g, ms, rad."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.rotations import column, turns
from mdlgen.model.tables import Floats, Ints, Model

# Columns of Result.contact_torque and of Result.contact_friction.
ON_A, ON_B = 0, 1
RUBS, GRIPS = 0, 1

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mdlgen.report.figures.plots import Plot
    from mdlgen.report.html.shown import Shown
    from mdlgen.results.contact_line import ContactLine
    from mdlgen.results.estimates import Estimate
    from mdlgen.results.losses import Losses
    from mdlgen.results.named import ProbeResult, RollerResult, SheetResult
    from mdlgen.results.strain import Strains
    from mdlgen.results.tension import Tension
    from mdlgen.results.verdict import Outcome


PARTIAL = "partial:"
OK, INACCURATE = "ok", "inaccurate"


@dataclass
class ContactStatistics:
    """Per row of Model.contacts, over every step of the run (not only the stored ones)."""

    max_depth: Floats  # greatest penetration [mm], (rows,)
    mean_depth: Floats  # mean over the time in contact of the greatest depth at a time [mm]
    max_force: Floats  # greatest total normal force [N]
    mean_force: Floats  # mean over the time in contact [N]
    # end of the last interval of force above 5 % of the greatest [ms]; 0: never, nan: it still acts
    last_force_at: Floats


@dataclass
class Energy:
    """Energy at the end and over the run [N mm]; `balance_error` is relative to `scale`, see `results.audit`.

    A positive one came from nowhere, a negative one got lost. It counts what was dissipated and what
    numerical damping took.
    """

    kinetic: float = 0.0
    elastic: float = 0.0
    dissipated: float = 0.0
    driven: float = 0.0
    balance_error: float = 0.0
    scale: float = 0.0
    # energy that the solver's own damping of joints took, not counted in `dissipated`; None: the solver does
    # not report it, and it is a part of balance_error
    numerical: float | None = None
    # parts that may ever touch each other have a balance of their own: those of the worst one, none: all
    of: tuple[str, ...] = ()
    # the part of `dissipated` that yielding took; None: nothing in the scene yields
    plastic: float | None = None
    # kinetic, elastic and potential energy that came in, and that left, with sheets; None: none does
    entered: float | None = None
    left: float | None = None


@dataclass(frozen=True)
class Chaos:
    """Divergence of two runs that differ only in the places of all sheets at the start."""

    quantity: str  # that run.tolerance judges, by its name
    start_mm: float  # by which the starts differ
    apart: float  # root mean square over the run, in `unit`
    step_apart: float  # the same of the run at twice the step
    unit: str
    sheet: str = ""  # whose start a sweep may vary


@dataclass
class Result:
    """States at the stored times and statistics over all steps.

    `status` is "ok", where the error is known to be within `run.tolerance`; "inaccurate", where the run is
    complete and its error estimate is above that, or is not known; else the reason of a failure, with the
    states up to there.
    """

    model: Model
    solver: str
    status: str  # OK, INACCURATE, or the reason of a failure
    time: Floats  # [ms], (t,)
    position: Floats  # centres [mm], (t, bodies, 3)
    rotation: Floats  # Euler parameters, scalar first, (t, bodies, 4)
    velocity: Floats  # [mm/ms], (t, bodies, 3)
    spin: Floats  # global axes [rad/ms], (t, bodies, 3)
    contact_force: Floats  # total normal force per contact row [N], (t, rows)
    statistics: ContactStatistics
    # of each contact row, of both parts: torque on it about its axis [N mm], 0 where it is no roller,
    # (t, rows, 2), ON_A and ON_B; None: of an older file, or another program
    contact_torque: Floats | None = None
    # friction along the surface of its roller as that turns, without one its size, and the most that it can
    # be, mu_static times the normal force [N], (t, rows, 2), RUBS and GRIPS
    contact_friction: Floats | None = None
    # plastic rotation of each row of Model.plastic [rad], (t, rows); None: nothing in the scene yields
    plastic: Floats | None = None
    # of each roller with an axle, by what angle it is behind its shaft, or what speed control has for that
    # [rad], (t, axles); None: no roller has a motor, a limiter or a bearing
    behind: Floats | None = None
    # when each sheet came in and left [ms], nan: it did not, (sheets, 2); None: all are there throughout
    stays: Floats | None = None
    touched: int = 0  # pairs that touched at any step
    energy: Energy = field(default_factory=Energy)
    step: float = 0.0  # [ms]
    steps: int = 0
    rounds: int | None = None  # an older name of `iterations`, which files keep
    # of all steps, where the solver counts them: "factors" that were made, "solves" with frozen contacts, and
    # steps that were "given_up" since they did not converge; no file keeps them
    counts: dict[str, int] = field(default_factory=dict)
    wall_s: float = 0.0
    estimate_s: float = 0.0  # of runs at other steps, from which the error is estimated
    build_s: float = 0.0
    compile_s: float = 0.0
    # the worst of the estimates that run.tolerance judges, None where there is none, and its name
    error_estimate: float | None = None
    error_estimate_of: str | None = None
    error_below: bool = False  # the estimate is a least value: the error is below it
    error_unknown: str = ""  # reason for which the error may be of any size; empty: there is no such reason
    search_ended: str = ""  # why no finer step was tried, where the estimate is above the tolerance
    chaotic: Chaos | None = None  # where two runs part whose starts nearly agree
    # by how much the value of each requirement may be wrong, in its unit, inf where that is not known; of an
    # event the number of times by which a run at another step differs
    doubts: dict[str, float] = field(default_factory=dict)
    checks: bool = False  # true where the run only checks another one at twice its step
    estimates: dict[str, Estimate] = field(default_factory=dict)  # see `results.estimates.complete`
    coarser: tuple[Result, ...] = field(default=(), repr=False)  # runs from which these follow, then none
    # readings of sensors and actions of rules, in the order of time, in the form of events
    reactions: tuple[dict[str, Any], ...] = ()
    halved: bool = False  # one side was solved, the other is its mirror image
    versions: dict[str, str] = field(default_factory=dict)
    ran_at: str = ""  # date and time at which the run ended, ISO 8601 in UTC; empty: not known
    source: str = ""  # the scene as it was written, with what was set on the command line

    def __repr__(self) -> str:
        end = self.time[-1] if len(self.time) else 0.0
        message = f"{self.model.name}, {self.solver}, {self.status}, {end:g} ms in {len(self.time)} states"
        return f"<Result {message}, {len(self.model.bodies.name)} bodies>"

    def _repr_html_(self) -> str:
        from mdlgen.results.notebook import tables

        return tables(self)

    @property
    def iterations(self) -> int | None:
        """Newton iterations of all steps, where the solver counts them."""
        return self.rounds

    @property
    def ok(self) -> bool:
        """True if the run is complete and its error is within the tolerance."""
        return self.status == OK

    @property
    def usable(self) -> bool:
        """True if the run is complete: there is a result to show and to compare, whose error may be above the
        tolerance or unknown."""
        return self.status in (OK, INACCURATE)

    @property
    def partial(self) -> bool:
        """True if it is a part of an interrupted run that was stored on request."""
        return self.status.startswith(PARTIAL)

    def part(self, reason: str) -> Result:
        """The same result, marked as a part."""
        return replace(self, status=f"{PARTIAL} {reason}")

    def failed(self, reason: str) -> Result:
        """The same result with a reason for its failure."""
        return replace(self, status=reason)

    def save(self, folder: str | Path) -> None:
        """Write summary.json, series.csv and result.h5 into `folder`. Raises OutputError."""
        from mdlgen.results.io.store import save

        save(self, Path(folder))

    @classmethod
    def load(cls, folder: str | Path) -> Result:
        """The result that `save` or `mdlgen run` wrote into `folder`. Raises OutputError."""
        from mdlgen.results.io.store import load

        return load(folder)

    def summary(self) -> dict[str, Any]:
        """The content of summary.json."""
        from mdlgen.results.summary import summary

        return summary(self)

    @property
    def verdict(self) -> list[Outcome]:
        """Outcomes of the requirements of the scene: `passed`, `value`, `margin`, `unit`; `str` of one is the
        line that `mdlgen run` prints."""
        from mdlgen.results.summary import summary
        from mdlgen.results.verdict import outcomes_of

        return outcomes_of(summary(self))

    def report(self, path: str | Path) -> Path:
        """Write the page of this run, report.html, to a file; its path. Raises OutputError."""
        from mdlgen.paths import write_atomic
        from mdlgen.report.html.page import page

        file = Path(path)
        write_atomic(file, page([self]).encode("utf-8"))
        return file

    def show(self, height: int = 720) -> Shown:
        """The page of this run, for a notebook; `height` in pixels."""
        from mdlgen.report.html.page import page
        from mdlgen.report.html.shown import Shown

        return Shown(page([self]), height)

    def plot(self, what: str = "travel") -> Plot:
        """One quantity over time: travel, speed, yaw, tension, roller_speed, nip_force, torque,
        power, contact_torque or probes. A notebook shows it,
        `save(path)` writes it as PNG, and `figure` is matplotlib's. Raises SpecError for another one."""
        from mdlgen.report.figures.plots import plot

        return plot(self, what)

    @property
    def sheets(self) -> Mapping[str, SheetResult]:
        """Results of the sheets, by name."""
        from mdlgen.results.named import sheets

        return sheets(self)

    @property
    def rollers(self) -> Mapping[str, RollerResult]:
        """Results of the rollers, by name."""
        from mdlgen.results.named import rollers

        return rollers(self)

    @property
    def probes(self) -> Mapping[str, ProbeResult]:
        """Motion of each probe, by name."""
        from mdlgen.results.named import probes

        return probes(self)

    def to_pandas(self) -> Any:
        """The content of series.csv, as a pandas.DataFrame over `time_ms`; units stand in the names of the
        columns. Needs the extra `pandas`.
        """
        from mdlgen.results.io.labelled import frame

        return frame(self)

    def to_xarray(self) -> Any:
        """The states as an xarray.Dataset over `time` [ms], `body` and `contact`, by their names, in the
        Model's units, which stand in `attrs`. Needs the extra `xarray`.
        """
        from mdlgen.results.io.labelled import dataset

        return dataset(self)

    @cached_property
    def strains(self) -> Strains | None:
        """Peak loads of the joints over the stored times; computed at the first access, and cached."""
        from mdlgen.model.curves import limits
        from mdlgen.results.strain import strains

        return strains(self, limits(self.model.curves))

    @cached_property
    def borne(self) -> Floats | None:
        """Loads of all joints at all stored times, see `results.strain.all_borne`; cached."""
        from mdlgen.results.strain import all_borne

        return all_borne(self)

    @cached_property
    def tensions(self) -> tuple[Tension | None, ...]:
        """Tension of each sheet along its way, see `results.tension`; computed at the first access,
        and cached."""
        from mdlgen.results.tension import tension_of

        return tuple(tension_of(self, k) for k in range(len(self.model.sheets)))

    @cached_property
    def lines(self) -> dict[int, tuple[Ints, ContactLine]]:
        """Contact lines of sheets on rollers by row, as `results.contact_line.of_row` works them out."""
        return {}

    @cached_property
    def losses(self) -> Losses | None:
        """Power that contacts take by friction and rolling, see `results.losses`; computed at the
        first access, and cached."""
        from mdlgen.results.losses import losses

        return losses(self)

    @cached_property
    def events(self) -> list[dict[str, Any]]:
        """Events of the sheets, by time; computed at the first access, and cached."""
        from mdlgen.results.events import events

        return events(self)

    def anchor_motion(self, index: int) -> tuple[Floats, Floats]:
        """Position [mm] and velocity [mm/ms] of probe `index` at the stored times, (t, 3) each."""
        anchor = self.model.probes[index]
        place, rate = np.zeros((len(self.time), 3)), np.zeros((len(self.time), 3))
        for body, local, share in zip(anchor.body, anchor.local, anchor.share, strict=True):
            arm = turns(self.rotation[:, body]) @ np.array(local)
            place += share * (self.position[:, body] + arm)
            rate += share * (self.velocity[:, body] + np.cross(self.spin[:, body], arm))
        return place, rate

    def sheet_velocity(self, index: int, at: int | slice = slice(None)) -> Floats:
        """Velocity of a sheet's centre of mass at stored times [mm/ms], (t, 3), or (3,) at one of them."""
        sheet = self.model.sheets[index]
        return self.model.mass_share(index) @ self.velocity[at, sheet.first : sheet.first + sheet.count]

    def sheet_motion(self, index: int) -> tuple[Floats, Floats, Floats]:
        """Centre of mass [mm], its velocity [mm/ms] and the yaw [rad] of a sheet, (t, 3), (t, 3), (t,).

        The yaw is the rotation of boxes about their own normals since the start. From the rotation of a box
        the shortest rotation that takes the sheet's first normal to the box's is removed; the rest is its
        yaw. So the yaw does not change where the sheet only bends or follows a curve. It is the mean over
        boxes, by their mass times cos^2 of half the angle between both normals. The turn of the sheet's x
        axis about z at the start is added.
        """
        sheet = self.model.sheets[index]
        boxes = slice(sheet.first, sheet.first + sheet.count)
        share = self.model.mass_share(index)
        place = share @ self.position[:, boxes]
        rate = self.sheet_velocity(index)
        x, y = (share @ column(self.rotation[:, boxes], k) for k in (0, 1))
        east, north = sheet.rotation[:, 0], sheet.rotation[:, 1]
        turn = np.arctan2(x @ north - y @ east, x @ east + y @ north)
        start = np.arctan2(sheet.rotation[1, 0], sheet.rotation[0, 0])
        return place, rate, start + np.unwrap(turn)
