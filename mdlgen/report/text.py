"""Overview and summary as a few lines for a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from mdlgen.lints.cost import Cost
from mdlgen.lints.smoothing import lines as smoothing_lines
from mdlgen.model.parts.kinds import KINDS
from mdlgen.report.overview import UNITS
from mdlgen.results.notable import foremost, notable
from mdlgen.results.result import INACCURATE, OK
from mdlgen.results.verdict import in_words, outcomes_of
from mdlgen.results.wording import number, numbers, percent

FIGURES = 4

FEW = 3  # names that are listed in a line
MOST_EVENTS = 5  # that a reader should know of, in words
_ALWAYS = ("rollers", "planes")  # that are counted where there are none, too

Rows = list[list[str]]  # of a table, the first with the names of its columns


def overview_text(record: dict[str, Any]) -> str:
    """The tables of `mdlgen check` where they are not for a terminal."""
    lines: list[str] = []
    for part in overview_parts(record):
        lines += [part] if isinstance(part, str) else _table(part)
    lines.append("")
    lines += [f"{x['code']} {x['where']}: {x['message']}; {x['remedy']}" for x in record["lints"]]
    lines.append(lints_end(record))
    return "\n".join(lines)


def lints_end(record: dict[str, Any]) -> str:
    return "mdlgen explain CODE says more" if record["lints"] else "no lints"


def overview_parts(record: dict[str, Any]) -> list[str | Rows]:
    """The output of `mdlgen check` before the lints: lines, and tables by rows."""
    lines: list[str | Rows] = [f"scene {record['scene']}, {record['analysis']}"]
    for names, sheet in _alike(record["sheets"]):
        size = " x ".join(f"{v:.5g}" for v in sheet["outline_mm"])
        lines += [
            "",
            f"{names}: {sheet['n_x']} x {sheet['n_y']} = {sheet['boxes']} boxes on {size} mm, "
            f"{sheet['bushings']} bushings, {sheet['layout']}, grid {sheet['grid']}",
            "",
            *_derived(sheet["derived"]),
            *_unlike(sheet["unlike"]),
            "",
            *_bending(sheet["bending"]),
            *_damping(sheet["derived"]),
            *_curves(sheet["curves"]),
        ]
    pairs = record["pairs"]
    lines += [
        "",
        ", ".join([f"{record[name]} {name}" for name in ("boxes", "bushings")] + _counts(record)),
        f"contact: {record['contacts']} pairs of parts; {pairs['possible']} pairs of bodies possible, "
        f"{pairs['kept']} kept{_searched(pairs)} (margin {pairs['margin_mm']:g} mm)",
        *smoothing_lines(record["smoothing"]),
        *(f"{name}: {said}" for name, of in record.get("covers", {}).items() for said in of["said"]),
    ]
    for name, mesh in record["meshes"].items():
        size = " x ".join(f"{v:.4g}" for v in mesh["size_mm"])
        left = f" ({mesh['left_out']} without an area left out)" if mesh["left_out"] else ""
        lines.append(
            f"mesh {name}: {mesh['file']}, {mesh['triangles']} triangles{left}, {size} mm, "
            f"{mesh['volume_mm3']:.4g} mm^3, {mesh['mass_g']:.4g} g"
        )
    if record["external_parts"]:
        parts = ", ".join(f"{name} ({part['body']})" for name, part in record["external_parts"].items())
        lines.append(f"external parts: {parts}; {pairs['external']} pairs of bodies with them, all kept")
    elif record["cost"] is not None:
        cost = Cost(**record["cost"])
        lines.append(f"a run takes {cost}{', mostly within a factor of 2' if cost.seconds >= 1.0 else ''}")
    return lines


def _alike(sheets: dict[str, Any]) -> list[tuple[str, Any]]:
    """Sheets by what is said of them, with the words for their names: those of a stream are all alike."""
    groups: list[tuple[list[str], Any]] = []
    for name, sheet in sheets.items():
        same = next((names for names, other in groups if other == sheet), None)
        if same is None:
            groups.append(([name], sheet))
        else:
            same.append(name)
    found = []
    for names, sheet in groups:
        all_of = ", ".join(names) if len(names) <= FEW else f"{names[0]}, {names[1]} to {names[-1]}"
        found.append((f"sheet {all_of}" if len(names) == 1 else f"{len(names)} sheets {all_of}", sheet))
    return found


def _counts(record: dict[str, Any]) -> list[str]:
    """Number of parts of each kind; most kinds are listed only where there are some."""
    found = []
    for kind in KINDS:
        parts = record[kind.table]
        if parts or kind.table in _ALWAYS:
            found.append(f"{len(parts) if isinstance(parts, dict) else parts} {kind.table}")
    return found


def _derived(values: dict[str, float]) -> list[str | Rows]:
    """The paper's Table 1 (the box) in a line, and Table 2 (one bushing) by axis."""
    box = [("d_x", "d"), ("d_y", "d"), ("m", "m"), ("I_x", "I"), ("I_y", "I"), ("I_z", "I")]
    record = ", ".join(f"{n} {values[n]:.5g} {UNITS[unit]}" for n, unit in box)
    rows = [["one bushing", "x", "y", "z", ""]]
    for symbol, axes, unit in (
        ("k", ("x", "y", "z"), "k"),
        ("c", ("x", "y", "z"), "c"),
        ("k_t", ("tx", "ty", "tz"), "kt"),
        ("c_t", ("tx", "ty", "tz"), "ct"),
    ):
        rows.append([symbol, *(f"{values[f'{symbol[0]}_{a}']:.5g}" for a in axes), UNITS[unit]])
    return [f"  box: {record}", rows, *(_plate(values) if "G" in values else [])]


def _unlike(record: dict[str, Any]) -> list[str]:
    """How boxes differ from the one above; nothing where all are alike and flat."""
    parts = []
    for key, name, unit in (("d_x_mm", "d_x", "mm"), ("d_y_mm", "d_y", "mm"), ("m_g", "m", "g")):
        if key in record:
            low, high = record[key]
            parts.append(f"{name} {low:.4g} to {high:.4g} {unit}")
    parts += [f"zone {name} on {count} boxes" for name, count in record.get("zones", {}).items()]
    bent = record.get("bent")
    if bent is not None:
        if "radius_mm" in bent:
            parts.append(f"curl {bent['radius_mm']:g} mm along {bent['along']}")
        parts += [name.replace("_", " ") for name in bent["creases"]]
        parts.append(f"begins {bent['start']}")
    return [f"  boxes differ: {', '.join(parts)}"] if parts else []


def _plate(values: dict[str, float]) -> list[str | Rows]:
    """Stiffness of joints of layout plate across themselves: k_y and k_tx along x, the others along y."""
    twist = ("tx_twist", "ty_twist")
    rows = [
        [
            "its others",
            "x shear",
            "y shear",
            "",
            "tx twist",
            "ty twist",
            "at free edges",
            "",
            "tz along y",
            "",
        ]
    ]
    for symbol in "kc":
        names = ("x_shear", "y_shear", *twist, *(f"{name}_edge" for name in twist), "tz_y")
        named = [f"{symbol}_{name}" for name in names]
        record = [f"{values[name]:.5g}" for name in named]
        rows.append([symbol, *record[:2], UNITS[symbol], *record[2:], UNITS[f"{symbol}t"]])
    own = f"G {values['G']:.5g} MPa, D_twist {values['D_twist']:.5g} {UNITS['D']}"
    if "nu_md" in values:
        own += f", nu_md {values['nu_md']:.4g}, nu_cd {values['nu_cd']:.4g}; all values are those of strips"
    return [f"  plate: {own}", rows]


def _bending(values: dict[str, float]) -> list[str | Rows]:
    rows = [["bending", "per bushing", UNITS["kt"], "per width", UNITS["D"]]]
    for way, hinge, plate in (("along x (MD)", "k_ty", "D_md"), ("along y (CD)", "k_tx", "D_cd")):
        rows.append([way, hinge, f"{values[hinge]:.5g}", plate, f"{values[plate]:.5g}"])
    return [rows]


def _damping(values: dict[str, float]) -> list[str]:
    """The damping times of MD and CD, where it is by time, and what they are as a loss factor."""
    if "tau_md" not in values:
        return []
    md, cd = values["tau_md"], values["tau_cd"]
    at = 0.1 * math.pi  # 50 Hz [rad/ms]
    return [
        f"  damping time MD {md:.5g} ms, CD {cd:.5g} ms "
        f"(loss factor at 50 Hz {at * md:.3g}, {at * cd:.3g}), on any grid"
    ]


def _curves(curves: dict[str, dict[str, Any]]) -> list[str]:
    lines = []
    for way, curve in curves.items():
        beyond = "straight on beyond" if curve["extrapolate"] == "linear" else "refused beyond"
        to = f"{curve['greatest_stress_mpa']:.5g} MPa at {100 * curve['greatest_strain']:.4g} %"
        start = f"slope {curve['initial_slope_mpa']:.5g} MPa at the start"
        lines.append(f"  curve_{way}: {start}, {curve['points']} points to {to}, {beyond}")
    return ["", *lines] if lines else []


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return ["  " + "  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in rows]


def _searched(pairs: dict[str, Any]) -> str:
    """The note about pairs that are not stored but searched."""
    count = pairs.get("searched", 0)
    many = "s" * (count > 1)
    return f" and those of sheets in {count} contact{many}, found as it runs" if count else ""


def _widened(pairs: dict[str, Any]) -> str:
    """The note about a margin that a run had to widen, empty where it had not."""
    margin, given = pairs.get("margin_mm"), pairs.get("margin_given_mm")
    if margin is None or given is None or margin <= given:
        return ""
    return (
        f"a body left the bounds of run.margin {given:g} mm; the run continued with {margin:g} mm. A list of "
        f"pairs in a text needs it too: mdlgen mdl .. --set run.margin={margin:g}mm"
    )


def summary_text(record: dict[str, Any]) -> str:
    """The output of `mdlgen run` for a summary."""
    pairs = record["pairs"]
    steps = f"{record['steps']} steps of {record['step_ms']:.4g} ms" if record["step_ms"] else "static"
    estimating = record["estimate_s"]
    # less than a millisecond is not a run, but the clock between two readings
    more = f"and {estimating:.2g} s more for the estimate of the error, " if estimating > 1e-3 else ""
    # warnings stand first
    lines = [record["mark"]] if record.get("mark") else []
    lines += [record["chaotic"]["in_words"]] if record.get("chaotic") else []
    status = record["status"] if record["status"] in (OK, INACCURATE) else "ended early"
    lines += [
        f"{record['scene']} ({record['solver']}): {status}, {record['t_end_ms']:.6g} ms, {steps}",
        f"solved in {record['wall_s']:.3g} s, {more}"
        f"after {record['build_s']:.2g} s to build and {record['compile_s']:.2g} s to compile",
        f"pairs: {pairs['possible']} possible, {pairs['kept']} kept{_searched(pairs)}, "
        f"{pairs['touched']} touched",
    ]
    if widened := _widened(pairs):
        lines.append(widened)
    lines += [str(outcome) for outcome in outcomes_of(record)]
    lines += [
        f"rule {k} never acted: {rule['when']}"
        for k, rule in enumerate(record.get("rules", ()))
        if not rule["acted"]
    ]
    happened = notable(record["events"]) if "verdict" in record else []
    shown, more = foremost(happened, MOST_EVENTS)
    lines += [in_words(event) for event in shown]
    if more:
        lines.append(f"and {len(happened) - len(shown)} more events: {more} (summary.json: verdict.events)")
    if record["halved"]:
        lines.append("one side was solved, the other is its mirror image (run.symmetry: false solves both)")
    for name, sheet in record["sheets"].items():
        lines.append(
            f"sheet {name}: travel {_vector(sheet['travel_mm'])} mm, "
            f"speed {_vector(sheet['speed_mm_per_s'])} mm/s, yaw {_number(sheet['yaw_deg'])} deg"
        )
        if sheet["strain"] is not None:
            lines.append(f"  {_bearing(sheet)}")
        if sheet.get("residual") is not None:
            lines.append(f"  {_residual(sheet['residual'])}")
        if sheet.get("tension") is not None:
            lines.append(f"  {_tension(sheet['tension'])}")
    for name, probe in record["probes"].items():
        lines.append(f"probe {name}: displacement {_vector(probe['displacement_mm'])} mm")
    if record.get("strain") is not None:
        lines.append(f"strain {record['strain']:.6g}")
    if record["rollers"]:
        lines += _rollers(record["rollers"])
    lines += _drags(record)
    plates = {name: plane for name, plane in record.get("planes", {}).items() if "center_mm" in plane}
    if plates:
        lines += _plates(plates)
    if record["error_estimate"] is not None and not record.get("error_unknown"):
        worst = f" ({record['error_estimate_of']})" if record["error_estimate_of"] else ""
        below = "below " if record.get("error_below") else ""
        lines.append(
            f"error estimate {below}{percent(record['error_estimate'])}{worst}, "
            f"tolerance {percent(record['tolerance'])}"
        )
    elif record.get("error_unknown"):
        lines.append(record["error_unknown"])
    elif record["error_estimate_of"]:
        lines.append(f"no error estimate: none for {record['error_estimate_of']}")
    unknown = [name for name, value in record["estimates"].items() if value is None]
    if unknown and len(unknown) < len(record["estimates"]):
        more = f" and {len(unknown) - FEW} more" if len(unknown) > FEW else ""
        lines.append(f"no estimate for {', '.join(unknown[:FEW])}{more} (summary.json: estimates)")
    return "\n".join(lines)


def _bearing(sheet: dict[str, Any]) -> str:
    """The joints that bore most, of all along x and y."""
    strain, curvature = sheet["strain"], sheet["curvature"]
    stretched = max(v for key, v in strain.items() if key.startswith("max_"))
    bent = max(v for key, v in curvature.items() if key.startswith("max_"))
    line = (
        f"strain up to {stretched:.3g} ({strain['joint']}), "
        f"curvature up to {bent:.3g} 1/mm ({curvature['joint']})"
    )
    if "margin" in strain:
        line += f"; {strain['margin']:.0%} left to the curve's end ({strain['margin_joint']})"
    return line


def _residual(left: dict[str, Any]) -> str:
    """The bend that a sheet keeps, where it may yield."""
    fold = left["fold"]
    return (
        f"keeps a curvature of up to {left['curvature_per_mm']:.3g} 1/mm ({left['joint']}) and folds up to "
        f"{fold['angle_deg']:.3g} deg ({fold['along'].upper()}, {fold['at_mm']:.3g} mm from the centre)"
    )


def _tension(tension: dict[str, Any]) -> str:
    """The pull and the push over a section along the way, and where and when."""
    way, figures = tension["along"].upper(), {key: _number(tension[key]) for key in tension if key != "along"}
    line = (
        f"tension along {way} up to {figures['max_n']} N ({figures['at_mm']} mm from the centre, "
        f"{figures['at_ms']} ms), mean {figures['mean_n']} N"
    )
    if figures["min_n"] != "0" and tension["min_n"] < 0.0:
        line += f"; pushed by up to {_number(-tension['min_n'])} N"
    return line


def _drags(record: dict[str, Any]) -> list[str]:
    """Friction drag of planes, guides and fixed meshes on sheets, where there is some."""
    rows = [["drag on sheets", "of", "N: mean", "peak"]]
    for kind in KINDS:
        for name, part in record.get(kind.table, {}).items():
            for sheet, contact in part["contacts"].items():
                if contact.get("max_drag_n"):
                    keys = ("mean_drag_n", "max_drag_n")
                    rows.append([sheet, name, *(_number(contact[key]) for key in keys)])
    return _table(rows) if len(rows) > 1 else []


def _rollers(rollers: dict[str, Any]) -> list[str]:
    rows = [
        ["roller", "rad/s", "nip N", "penetration by sheets: max mm", "mean mm", "free of counterpart at ms"]
    ]
    for name, roller in rollers.items():
        keys = ("omega_rad_per_s", "nip_force_n", "max_penetration_mm", "mean_penetration_mm")
        free = roller["free_of_counterpart_at_ms"]
        rows.append(
            [name, *(_number(roller[key]) for key in keys), "acts" if free is None else f"{free:.4g}"]
        )
    return [*_table(rows), *_drives(rollers)]


def _drives(rollers: dict[str, Any]) -> list[str]:
    """Torque and power of drives, and the grip reserve of sheets and rollers."""
    rows = [["drive", "torque N mm: mean", "peak", "power W: mean", "peak", "grip left"]]
    for name, roller in rollers.items():
        if not roller.get("max_torque_n_mm"):
            continue
        keys = ("mean_torque_n_mm", "max_torque_n_mm", "mean_power_w", "max_power_w")
        held = {other: grip["reserve"] for other, grip in roller["traction"].items()}
        left = ", ".join(f"{other} {part:.0%}" for other, part in held.items() if part is not None)
        rows.append([name, *(_number(roller[key]) for key in keys), left or "-"])
    return _table(rows) if len(rows) > 1 else []


def _plates(plates: dict[str, Any]) -> list[str]:
    """The pressed plates."""
    rows = [["spring plate", "centre mm", "force N", "penetration by sheets: max mm", "mean mm"]]
    for name, plate in plates.items():
        keys = ("nip_force_n", "max_penetration_mm", "mean_penetration_mm")
        rows.append([name, _vector(plate["center_mm"]), *(_number(plate[key]) for key in keys)])
    return _table(rows)


def _number(value: float | None) -> str:
    return "-" if value is None else number(value, FIGURES)


def _vector(values: Sequence[float | None] | None) -> str:
    return "-" if values is None else f"({', '.join(numbers(values, FIGURES, '-'))})"
