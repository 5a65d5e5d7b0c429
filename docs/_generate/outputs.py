"""What a run leaves: every key of summary.json, every column and dataset, each described here by hand.

A test runs scenes and looks that nothing that they leave is missing here.
"""

from __future__ import annotations

import re

from columns import SERIES, STATES
from markdown import NOTE, table

from mdlgen.model.parts.kinds import KINDS

CONTACT = "contacts.OTHER"
PARTS = [kind.table for kind in KINDS]
# key, with capitals for names of the scene's -> (unit, meaning)
SUMMARY: dict[str, tuple[str, str]] = {
    "scene": ("", "name of the scene"),
    "solver": ("", "`lattice` or `exudyn`"),
    "status": (
        "",
        "`ok`; `inaccurate`: the run is complete, its error is above `run.tolerance` or is not known; else "
        "why the run ended early, or was cut off",
    ),
    "mark": ("", "one line that says what is wrong with a run that is not `ok`; null: nothing"),
    "duration_ms": ("ms", "`run.duration`"),
    "t_end_ms": ("ms", "time at the end of the run"),
    "steps": ("", "time steps taken"),
    "step_ms": ("ms", "nominal time step"),
    "iterations": ("", "Newton iterations, where the solver counts them"),
    "rounds": ("", "the same; an older name"),
    "wall_s": ("s", "wall time of the solver alone"),
    "estimate_s": ("s", "wall time of the runs that the error estimate took"),
    "compile_s": ("s", "time for compiling the solver, 0 once it is compiled"),
    "build_s": ("s", "time from the Model to the solver's own tables"),
    "pairs.possible": ("", "pairs of bodies that the contacts name"),
    "pairs.kept": ("", "of these, pairs that can meet within the swept bounds"),
    "pairs.searched": (
        "",
        "contacts of two sheets with too many pairs to list; they are found as it runs",
    ),
    "pairs.touched": ("", "pairs that touched in the run, of those kept and those found"),
    "pairs.margin_mm": ("mm", "margin that the pairs were chosen with: the widest one that the run needed"),
    "pairs.margin_given_mm": ("mm", "`run.margin`, the first one; null in files of an older version"),
    "halved": ("", "true where one half of a symmetric scene was solved and mirrored"),
    "error_estimate": ("", "the greatest estimate of those that `run.tolerance` judges; null if not known"),
    "error_estimate_of": ("", "name of that estimate"),
    "error_below": ("", "whether the estimate is a least value: the error is below it"),
    "search_ended": ("", "why no finer step was tried, of an inaccurate run whose step was searched"),
    "chaotic": (
        "",
        "of a run that no step brings within the tolerance, else null: `quantity`, `start_mm` by which the "
        "starts of two runs differ, `apart_mm` by which they part, `step_apart_mm` by which half the step "
        "changes it (of an arm `apart_rad`), and `in_words` with the command of a sweep",
    ),
    "error_unknown": ("", "why the error may be of any size; null: nothing says so"),
    "tolerance": ("", "`run.tolerance`"),
    "energy.kinetic": ("N mm", "kinetic energy at the end"),
    "energy.elastic": ("N mm", "elastic energy at the end, of joints, contacts and springs"),
    "energy.dissipated": ("N mm", "energy taken by damping, friction and restitution"),
    "energy.numerical": ("N mm", "energy taken by the numerical damping of the integrator; null with exudyn"),
    "energy.plastic": (
        "N mm",
        "the part of `energy.dissipated` that sheets took as they yielded; null where none can",
    ),
    "energy.driven": ("N mm", "work of drives and loads"),
    "energy.entered": (
        "N mm",
        "energy with which sheets came in later, null where none comes or leaves",
    ),
    "energy.left": ("N mm", "energy with which sheets left, null where none comes or leaves"),
    "energy.balance_error": (
        "",
        "error of the energy balance over `energy.scale`; positive: a gain",
    ),
    "energy.scale": ("N mm", "energy that passes through the run"),
    "energy.friction": (
        "N mm",
        "what contacts took by friction and rolling, over the stored states; see [size a drive]"
        "(../how-to/size-a-drive.md)",
    ),
    "energy.other_losses": (
        "N mm",
        "the rest of all that was dissipated but by yielding: by dampers of joints, presses and normal "
        "forces, in contacts "
        "of sheets with each other and of meshes, and between stored states",
    ),
    "energy.drives": ("N mm", "what the drives gave by their torques, over the stored states"),
    "energy.drives_unseen": (
        "N mm",
        "what the solver has besides that, with the kinetic energy of driven rollers: between stored states, "
        "and work of loads",
    ),
    "events": ("", "list of [events](events.md)"),
    "estimates.QUANTITY": ("", "error estimate of each quantity, relative to its scale; null if not known"),
    "estimates_below": ("", "names of the estimates that are least values: the error is below them"),
    "estimate_scales.QUANTITY.scale": ("", "scale of that estimate"),
    "estimate_scales.QUANTITY.unit": ("", "unit of the scale"),
    "strain": ("", "elongation over flexible length, of a clamped strip under edge stress"),
    "verdict.passed": ("", "whether all that `require` asks for is there; null: it asks for nothing"),
    "verdict.requirements": (
        "",
        "`requirement`, `passed`, `value`, `unit`, `margin` (below zero: what is missing) of each; "
        "`doubtful`: whether the error of the run could turn it round",
    ),
    "verdict.events": ("", "jams, double feeds, stubs, creep where friction holds and large slips in words"),
    "versions.PACKAGE": (
        "",
        "versions of mdlgen, Python, numpy and the solver; `code`: what its machine code was made for, and "
        "the beginning of its SHA-256",
    ),
    "sheets.NAME.travel_mm": ("mm", "displacement of the centre of mass, [x, y, z]"),
    "sheets.NAME.speed_mm_per_s": ("mm/s", "velocity of the centre of mass at the end, [x, y, z]"),
    "sheets.NAME.yaw_deg": (
        "deg",
        "turn of the sheet about its normal, with the `turn` that it begins with; it does not change where "
        "the sheet only bends or goes round a curve",
    ),
    "sheets.NAME.entered_ms": ("ms", "when it came in, null if it did not; where sheets come in or leave"),
    "sheets.NAME.left_ms": ("ms", "when it left, null if it did not"),
    "sheets.NAME.way_mm": (
        "mm",
        "mean way of its boxes in their own planes: along the path also round a bend, where travel is less",
    ),
    "sheets.NAME.mean_speed_mm_per_s": (
        "mm/s",
        "mean speed of its boxes in their own planes, over the last tenth of the run",
    ),
    "sheets.NAME.skew_deg": (
        "deg",
        "turn of the sheet's nearer side against its way, about its normal, over the last tenth of the run; "
        "null where it stands",
    ),
    "sheets.NAME.boxes": ("", "number of boxes"),
    "sheets.NAME.bushings": ("", "number of bushings"),
    "sheets.NAME.strain": ("", "null for a sheet without joints"),
    "sheets.NAME.strain.max_md": ("", "greatest membrane strain of a joint along MD; `max_cd`: along CD"),
    "sheets.NAME.strain.max_cd": ("", "the same along CD"),
    "sheets.NAME.strain.min_md": ("", "least membrane strain of a joint along MD; `min_cd`: along CD"),
    "sheets.NAME.strain.min_cd": ("", "the same along CD"),
    "sheets.NAME.strain.margin": ("", "least distance to the end of a measured curve, as a part of it"),
    "sheets.NAME.strain.margin_joint": ("", "joint with that distance"),
    "sheets.NAME.residual": (
        "",
        "the bend that the sheet keeps at the end without moment; null where its material has no `yield`",
    ),
    "sheets.NAME.residual.curvature_per_mm": (
        "1/mm",
        "greatest one of a joint, positive towards the normal of the sheet",
    ),
    "sheets.NAME.residual.strain": ("", "strain of the faces of the sheet with that curvature"),
    "sheets.NAME.residual.along": ("", "`md` or `cd`: direction that is bent there"),
    "sheets.NAME.residual.at_mm": ("mm", "its place on the sheet, [x, y] from its centre"),
    "sheets.NAME.residual.joint": ("", "its joint"),
    "sheets.NAME.residual.fold.angle_deg": (
        "deg",
        "greatest mean angle that the joints of one line across the sheet keep",
    ),
    "sheets.NAME.residual.fold.along": ("", "`md` or `cd`: direction that is folded"),
    "sheets.NAME.residual.fold.at_mm": ("mm", "where along it, from the centre of the sheet"),
    "sheets.NAME.residual.curl_md_per_mm": (
        "1/mm",
        "mean curvature along MD; its inverse: radius of the curl",
    ),
    "sheets.NAME.residual.curl_cd_per_mm": ("1/mm", "the same along CD"),
    "sheets.NAME.curvature": ("", "null for a sheet without joints"),
    "sheets.NAME.curvature.max_md_per_mm": ("1/mm", "greatest curvature along MD, without sign"),
    "sheets.NAME.curvature.max_cd_per_mm": ("1/mm", "greatest curvature along CD, without sign"),
    "sheets.NAME.twist": ("", "null for a sheet without joints"),
    "sheets.NAME.twist.max_per_mm": ("1/mm", "greatest twist, without sign"),
    **{
        f"sheets.NAME.{what}.{key}": words
        for what in ("strain", "curvature", "twist")
        for key, words in {
            "at_mm": ("mm", "place of the greatest value on the sheet, [x, y] from its centre"),
            "at_ms": ("ms", "its time"),
            "joint": ("", "its joint"),
        }.items()
    },
    "sheets.NAME.energy.kinetic_n_mm": ("N mm", "by how much its kinetic energy grew"),
    "sheets.NAME.energy.friction_n_mm": (
        "N mm",
        "what its contacts with rollers, planes and guides took by friction and rolling",
    ),
    "sheets.NAME.tension": (
        "",
        "membrane force over the sections across its way, positive where it is pulled; null for a sheet "
        "without joints along it",
    ),
    **{
        f"sheets.NAME.tension.{key}": words
        for key, words in {
            "along": ("", "`md` or `cd`: away from its clamp, else where it goes, else where it bears more"),
            "max_n": ("N", "the greatest of all sections and stored times"),
            "at_mm": ("mm", "its section, along the way from the sheet's centre"),
            "at_ms": ("ms", "its time"),
            "min_n": ("N", "the least, below zero where the sheet is pushed"),
            "least_at_mm": ("mm", "its section"),
            "least_at_ms": ("ms", "its time"),
            "mean_n": ("N", "mean over the run, of that section of which it is greatest in size"),
            "mean_at_mm": ("mm", "that section"),
        }.items()
    },
    "rollers.NAME.omega_rad_per_s": ("rad/s", "speed about the roller's axis at the end"),
    **{
        f"rollers.NAME.{key}": words
        for key, words in {
            "torque_n_mm": ("N mm", "torque of its drive about its axis at the end; 0 of a free roller"),
            "max_torque_n_mm": ("N mm", "that which is greatest in size of the stored times"),
            "mean_torque_n_mm": ("N mm", "its mean over the run"),
            "power_w": ("W", "power that its drive gives at the end"),
            "max_power_w": ("W", "that which is greatest in size of the stored times"),
            "mean_power_w": ("W", "its mean over the run"),
            "stalled": ("", "of a motor: whether it stalls at the end"),
            "stalled_for_ms": ("ms", "and for how long in all"),
            "lost_steps": ("", "of a stepper: steps that it has lost, below 0 where it ran ahead"),
            "limiter_slips_for_ms": ("ms", "of a torque limiter: for how long it slips"),
            "contact_torque_n_mm": ("N mm", "torque of its contacts about its axis at the end"),
            "max_contact_torque_n_mm": ("N mm", "that which is greatest in size of the stored times"),
            "mean_contact_torque_n_mm": ("N mm", "its mean over the run"),
            "traction.OTHER.tangential_n": (
                "N",
                "mean friction along its surface, without sign, at the stored times at which the two touch; "
                "null if they never do",
            ),
            "traction.OTHER.limit_n": ("N", "mean of the most that it can be, mu_static N, at these times"),
            "traction.OTHER.reserve": ("", "part of the grip that is left: 1 - tangential_n / limit_n"),
            "traction.OTHER.least_reserve": ("", "the least that is left at any stored time"),
        }.items()
    },
    "rollers.NAME.free_of_counterpart_at_ms": (
        "ms",
        "time at which the force between it and other rollers ended, for the last time: a sheet came between "
        "them, or it was lifted; 0 where there was none, null where one acts at the end",
    ),
    **{
        f"{part}.NAME.{key}": words
        for part in ("rollers", "planes")
        for key, words in {
            "center_mm": ("mm", "centre at the end, [x, y, z]; of a plane only where it is pressed"),
            "slide_mm": (
                "mm",
                "way of one that is pressed along its press direction at the end, from where it is given: it "
                "falls as a sheet lifts it",
            ),
            "max_slide_mm": ("mm", "the greatest of the stored times"),
            "min_slide_mm": ("mm", "the least of the stored times"),
            "max_penetration_mm": ("mm", "greatest depth in sheets"),
            "mean_penetration_mm": ("mm", "mean depth in sheets over the time in contact"),
        }.items()
    },
    **{
        f"{part}.NAME.{key}": words
        for part in ("planes", "guides", "meshes")
        for key, words in {
            "angle_deg": ("deg", "turn about its pivot at the end, from where it is given"),
            "max_angle_deg": ("deg", "the greatest of the stored times"),
            "min_angle_deg": ("deg", "the least of the stored times"),
            "slide_mm": ("mm", "way along its slide at the end, or that of a press, from where it is given"),
            "max_slide_mm": ("mm", "the greatest of the stored times"),
            "min_slide_mm": ("mm", "the least of the stored times"),
        }.items()
    },
    "rollers.NAME.energy.driven_n_mm": ("N mm", "what its drive gave; null of a free roller"),
    "rollers.NAME.mean_nip_force_n": (
        "N",
        "of one with a cover: mean of the force of sheets on it, or of the other roller, while it acts",
    ),
    "rollers.NAME.nip_width_mm": ("mm", "width of its nip under that force"),
    "rollers.NAME.speed_ratio": (
        "",
        "speed of a sheet on it over that of its undeformed surface, under that force",
    ),
    "rollers.NAME.arm_deg": ("deg", "turn of its arm at the end since it was given, about the roller's axis"),
    "rollers.NAME.max_arm_deg": ("deg", "the greatest of the stored times"),
    "rollers.NAME.min_arm_deg": ("deg", "the least of the stored times"),
    **{
        f"{part}.NAME.energy.friction_n_mm": (
            "N mm",
            "what its contacts with sheets took by friction and rolling, and half of what is between it and "
            "another part; null where none has an account",
        )
        for part in PARTS
    },
    **{f"{part}.NAME.nip_force_n": ("N", "sum of the normal forces on it at the end") for part in PARTS},
    **{
        f"{part}.NAME.{CONTACT}.{key}": words
        for part in PARTS
        for key, words in {
            "max_penetration_mm": ("mm", "greatest depth of the pair"),
            "mean_penetration_mm": ("mm", "mean depth over the time in contact"),
            "max_force_n": ("N", "greatest normal force of the pair"),
            "mean_force_n": ("N", "mean normal force over the time in contact"),
        }.items()
    },
    **{
        f"{part}.NAME.{CONTACT}.{key}": words
        for part in PARTS
        if part != "rollers"
        for key, words in {
            "drag_n": ("N", "friction that it takes from a sheet at the end"),
            "max_drag_n": ("N", "the greatest of the stored times"),
            "mean_drag_n": ("N", "mean over the stored times at which the two touch"),
        }.items()
    },
    "probes.NAME.displacement_mm": ("mm", "displacement at the end, [x, y, z]"),
    "probes.NAME.speed_mm_per_s": ("mm/s", "velocity at the end, [x, y, z]"),
    "rules": ("", "each rule: its condition `when`, and how often it `acted`"),
    "sensors.NAME.count": ("", "how often a sensor was covered"),
    "sensors.NAME.covered": ("", "whether it is covered at the end"),
    "sensors.NAME.passed": (
        "",
        "each sheet that went by, with times in ms; see "
        "[let a machine react](../how-to/let-a-machine-react.md)",
    ),
}


def summary_page() -> str:
    """reference/summary.md."""
    rows = [(f"`{key}`", unit, words) for key, (unit, words) in SUMMARY.items()]
    columns = [(f"`{key}`", unit, words) for key, (unit, words) in SERIES.items()]
    data = [(f"`{key}`", shape, unit, words) for key, (shape, unit, words) in STATES.items()]
    return f"""{NOTE}# The files of a run

`mdlgen run SPEC -o DIR` writes these files together. The files of an earlier run stay as they were until the
new ones are complete.

| file | holds |
|---|---|
| `summary.json` | the numbers that one reads first |
| `series.csv` | motion and forces over time |
| `result.h5` | every body at every stored time, and the Model |
| `report.html` | the [page](../how-to/read-the-report.md): with `--page`, or once `mdlgen view DIR` made it |
| `report.png`, `strain.png` | with `--pictures` |
| `checkpoint/` | the state from which `--resume` goes on, while a run is under way |

## summary.json

Words in capitals stand for names of your scene. Vectors are [x, y, z]. A number that the run did not reach is
null. A penetration of a roller counts sheets only; `contacts` has each pair of parts.

{table(("key", "unit", "meaning"), rows)}
Names of `estimates` are places in this file without their units, such as `sheets.note.position`. See
[the error estimate](../theory/estimates.md).

## series.csv

{table(("column", "unit", "meaning"), columns)}
## result.h5

HDF5. All values are in mm, N, g, ms and rad, the units inside mdlgen. `mdlgen.Result.load(DIR)` reads it; so
does any HDF5 reader.

{table(("dataset", "shape", "unit", "meaning"), data)}"""


def pattern(key: str) -> re.Pattern[str]:
    """Matches a dotted key of a file against one of the tables here."""
    names = re.sub(r"[A-Z]{4,}", "\0", key)
    return re.compile(re.escape(names).replace("\0", "[^/]+"))
