"""A run as MotionSolve would have recorded it: its plot file, and the table that a script writes."""

from __future__ import annotations

from collections.abc import Callable
from io import StringIO

import numpy as np

from mdlgen.altair.recorded import recorded
from mdlgen.model.tables import Floats
from mdlgen.results.result import Result

Names = Callable[[str, str], str]  # of the name and the comment of a request, what stands in the file
SECOND = 1000.0


def comment(name: str, text: str) -> str:
    """What decks have."""
    return text


def label(name: str, text: str) -> str:
    """What scripts have."""
    return name


def requests(result: Result) -> dict[tuple[str, str], Floats]:
    """Six numbers of each request over the stored times, by name and comment, (t, 6).

    The force of a contact has its size along x: no more of its direction is in a result.
    """
    found: dict[tuple[str, str], Floats] = {}
    model = result.model
    for k, probe in enumerate(model.probes):
        place, rate = result.anchor_motion(k)
        name = f"o_{probe.name}", f"Probe {probe.name}: position, velocity"
        found[name] = np.hstack([place, rate * SECOND])
    for roller in model.rollers:
        name = f"o_{roller.name}", f"Roller {roller.name}: position, spin"
        spin = result.spin[:, roller.body] * SECOND
        found[name] = np.hstack([result.position[:, roller.body], spin])
    for plane in model.planes:
        if plane.press is not None:
            name = f"o_{plane.name}", f"Plane {plane.name}: position, velocity"
            rate = result.velocity[:, plane.body] * SECOND
            found[name] = np.hstack([result.position[:, plane.body], rate])
    axes = {roller.name: roller.axis for roller in model.rollers}
    assert result.contact_friction is not None and result.contact_torque is not None
    for row in recorded(model):
        by, on = model.contacts.part_a[row], model.contacts.part_b[row]
        name = f"o_{by}_on_{on}", f"Contact of {by} on {on}: force, torque"
        six = np.zeros((len(result.time), 6))
        six[:, 0] = np.hypot(result.contact_force[:, row], result.contact_friction[:, row, 0])
        if on in axes:
            six[:, 3:] = result.contact_torque[:, row, 1:] * axes[on]
        found[name] = six
    return found


def plt(result: Result, called: Names = comment, later: float = 0.0) -> str:
    """A plot file; `later` shifts its times [ms]. Line ends, widths and digits are those of a real one."""
    found = requests(result)
    lines = ["MotionSolve v9.1 Plot File", "Generated on  1-JAN-2026 12:00:00, Altair Engineering, Inc."]
    lines.append(f"{len(found):5d}     MMKGS_N_RACA  1.000000000000000e+03")
    for id, name in enumerate(found, 1):
        text = called(*name)
        lines += [f"{id:11d}{5:14d}{0:14d}{0:14d}{-(-len(text) // 4):14d}", text]
    for k, time in enumerate(((result.time + later) / SECOND).tolist()):
        lines.append(f"{time:14.5E}")
        lines += [
            "".join(f"{v:14.5E}"[0 if n == 0 else 1 :] for n, v in enumerate(row[k]))
            for row in found.values()
        ]
    return "\r\n".join(lines) + "\r\n"


def split_in_parts(text: str, label: str, names: tuple[str, str]) -> str:
    """A plot file in which one request is two: a quarter of its numbers, and the rest."""
    lines = text.splitlines()
    at = lines.index(label)
    count = int(lines[2].split()[0])
    which = (at - 4) // 2
    head = [*lines[:2], f"{count + 1:5d}" + lines[2][5:], *lines[3 : at - 1]]
    for part, name in enumerate(names, 1):
        head += [f"{90 + part:11d}" + lines[at - 1][11:], name]
    head += lines[at + 1 : 3 + 2 * count]
    body = []
    for k in range(3 + 2 * count, len(lines), count + 1):
        block = lines[k : k + count + 1]
        numbers = [float(v) for v in block[1 + which].split()]
        parts = [[0.25 * v for v in numbers], [0.75 * v for v in numbers]]
        split = (" ".join(f"{v:.9E}" for v in part) for part in parts)
        body += [*block[: 1 + which], *split, *block[2 + which :]]
    return "\r\n".join((*head, *body)) + "\r\n"


def table(result: Result, called: Names = label) -> str:
    """The table that a script writes, NAME_requests.csv."""
    found = requests(result)
    names = [f"{called(*name)}.f{k}" for name in found for k in (2, 3, 4, 6, 7, 8)]
    stream = StringIO()
    stream.write(",".join(["time", *(f'"{name}"' if "," in name else name for name in names)]) + "\r\n")
    for row in np.hstack([result.time[:, None] / SECOND, *found.values()]).tolist():
        stream.write(",".join(map(repr, row)) + "\r\n")
    return stream.getvalue()
