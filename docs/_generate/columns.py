"""Every column of series.csv and every dataset of result.h5, each described here by hand."""

from __future__ import annotations

SERIES: dict[str, tuple[str, str]] = {
    "time_ms": ("ms", "stored times, `run.print_step` apart"),
    "NAME.x_mm": ("mm", "position of a sheet's centre of mass or a probe; so too `y_mm`, `z_mm`"),
    "NAME.y_mm": ("mm", "the same along y"),
    "NAME.z_mm": (
        "mm",
        "the same along z; of a roller or pressed plate, x, y and z of its centre where it moves along them, "
        "z of a roller that stands",
    ),
    "NAME.vx_mm_per_s": ("mm/s", "velocity of it; so too `vy_mm_per_s`, `vz_mm_per_s`"),
    "NAME.vy_mm_per_s": ("mm/s", "the same along y"),
    "NAME.vz_mm_per_s": ("mm/s", "the same along z"),
    "NAME.yaw_deg": ("deg", "turn of a sheet about its normal, as `yaw_deg` of the summary"),
    "NAME.tension_max_n": ("N", "greatest tension of a sheet's sections along its way"),
    "NAME.tension_min_n": ("N", "the least, below zero where one is pushed"),
    "NAME.omega_rad_per_s": ("rad/s", "speed of a roller about its axis"),
    "NAME.slide_mm": (
        "mm",
        "way of a pressed roller or plate along its press direction, or of a part along its slide, from "
        "where it is given",
    ),
    "NAME.angle_deg": ("deg", "turn of a plane, guide or mesh about its pivot, from where it is given"),
    "NAME.torque_n_mm": ("N mm", "torque that the drive of a roller gives about its axis"),
    "NAME.power_w": ("W", "power that it gives"),
    "NAME.arm_deg": ("deg", "turn of a roller's arm since it was given, about the roller's axis"),
    "NAME.driven_energy_n_mm": ("N mm", "what a drive has given since the start"),
    "NAME.friction_loss_n_mm": ("N mm", "what contacts of a part have taken by friction and rolling"),
    "NAME.contact_torque_n_mm": ("N mm", "torque of contacts on a roller about its axis"),
    "NAME.OTHER.tangential_n": ("N", "friction along a roller's surface, as it turns, by another part"),
    "NAME.OTHER.drag_n": ("N", "friction of a plane, guide or mesh on a sheet, by its size"),
    "NAME.force_n": ("N", "sum of the normal forces on a roller, plane, guide or mesh"),
}
STATES: dict[str, tuple[str, str, str]] = {
    "time": ("(t,)", "ms", "stored times"),
    "position": ("(t, body, 3)", "mm", "centres of mass of all bodies"),
    "rotation": ("(t, body, 4)", "", "unit quaternions, scalar first"),
    "velocity": ("(t, body, 3)", "mm/ms", "velocities of the centres of mass"),
    "spin": ("(t, body, 3)", "rad/ms", "angular velocities, global axes"),
    "contact_force": ("(t, contact)", "N", "normal force of each pair of parts"),
    "contact_torque": ("(t, contact, 2)", "N mm", "torque on both parts of each pair about their axes"),
    "contact_friction": (
        "(t, contact, 2)",
        "N",
        "friction along the roller's surface, and the most that it can be; without a roller its size",
    ),
    "bodies": ("(body,)", "", "names of bodies: boxes `note_4_7` (column 4, row 7), then the machine"),
    "contacts": ("(contact,)", "", "pairs of parts, `a / b`"),
    "statistics/max_depth": ("(contact,)", "mm", "greatest depth"),
    "statistics/mean_depth": ("(contact,)", "mm", "mean depth over the time in contact"),
    "statistics/max_force": ("(contact,)", "N", "greatest normal force"),
    "statistics/mean_force": ("(contact,)", "N", "mean normal force over the time in contact"),
    "statistics/last_force_at": ("(contact,)", "ms", "end of the last interval of force; nan if it acts yet"),
    "stays": (
        "(sheet, 2)",
        "ms",
        "when each sheet came in and left, nan if it did not; where some do during the run",
    ),
    "joints/...": ("(joint,)", "", "peaks of strain, curvature and twist of each joint, with their times"),
    "model/...": ("", "", "the Model of the run, from which `mdlgen.Result.load` rebuilds all"),
    "took": ("(4,)", "s", "wall, estimate, build and compile time"),
}
