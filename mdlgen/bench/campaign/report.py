"""A campaign as text: the output of the command, and the page of the manual."""

from __future__ import annotations

import inspect
from collections.abc import Iterable

from mdlgen.bench.campaign.counts import Counts, counts, grouped
from mdlgen.bench.campaign.draw import RANGES
from mdlgen.bench.campaign.finer import ABOVE, FAR
from mdlgen.bench.campaign.found import Campaign
from mdlgen.bench.campaign.kinds import KINDS
from mdlgen.bench.campaign.row import INACCURATE, NONE, CampaignRow
from mdlgen.bench.campaign.sheets import SHARES, STOCKS
from mdlgen.bench.numerals import time
from mdlgen.errors import printable

# Numbers of scenes that a line lists.
LISTED = 12

HEAD = """# Random scenes

`mdlgen bench campaign --count 1000 --seed 1` draws scenes at random and runs each with default settings. It
counts results, inaccurate results and failures. Seed and number determine a scene: `--seed 1 --only 17` runs
scene 17 again. `-o DIR` names the folder of the output. `DIR/scenes` holds the file of each scene without a
result or with an inaccurate one, and of scenes that `--only` names. `campaign.json` holds all rows.

The command `mdlgen bench campaign --count 1000 --seed N --page docs/validation/campaign.md` writes this page.
Each release uses another seed.
"""

GENERATOR = """## How scenes are drawn

The kind of a scene is drawn by its share. A scene that `mdlgen check` does not accept is drawn again; the
table counts these. Values have three digits. Their ranges are below, if the kind does not say otherwise.
Values are uniform, or uniform in their logarithm:
"""

SHEETS = """A sheet is paper, board or a card. Its boxes are about square. A tenth of the sheets have one row
of boxes. Sheets between rollers have at least 12 boxes, of 8 mm at most along x. Half of the sheets have the
layout `edge_to_edge`, a quarter `center_to_center`, a quarter `plate`. Bending stiffness is 0.6 to 1.2 times
E s^3/12; a tenth of the materials leave it out. Three in ten materials have a damping.

The force of a nip is limited so that no roller is pressed in by more than 0.45 of the thickness. Rollers are
solid, with a density of 1 to 2.8 g/cm^3. A fifth of the contacts leave out `restitution`, a third leave out
`smoothing`. The friction of guides is 0.5 at most.
"""

KINDS_HEAD = "Kinds, with their share of the scenes:"


def table(found: Campaign) -> str:
    """The output of the command."""
    return "\n".join([*_head(found), "", *_body(found), ""])


def page(found: Campaign) -> str:
    """The page of the manual."""
    return "\n".join([HEAD, *_head(found), "", *_body(found), "", *_generator()])


def _head(found: Campaign) -> list[str]:
    versions = ", ".join(f"{name} {number}" for name, number in found.versions.items())
    cpu = found.machine.get("cpu", "")
    sticks = ", friction that sticks in every second contact" if found.sticking else ""
    scenes = f"{len(found.rows)} scenes{sticks}"
    return [f"Seed {found.seed}, {scenes}; {cpu}, one core for each scene; {versions}."]


def _body(found: Campaign) -> list[str]:
    made = counts(found.rows)
    lines = [_line(("outcome", "scenes", "part")), _line(("---",) * 3)]
    for name, number in (
        ("with a result (exit 0)", made.ok),
        ("marked inaccurate (exit 5)", made.inaccurate),
        ("of these chaotic", made.chaotic),
        ("without a result", made.none),
        (f"of these above {found.limit:g} s", made.stopped),
        ("rejected at check, drawn again", made.rejected),
    ):
        lines.append(_line((name, str(number), _part(number, made.scenes))))
    lines += ["", *_times(made), "", *_finer(made), "", *_kinds(found.rows)]
    for title, status in (("Without a result", NONE), ("Inaccurate", INACCURATE)):
        lines += ["", f"## {title}", "", *_groups(found.rows, status)]
    return [*lines, "", "## Errors above their estimates", "", *_off(found.rows)]


def _times(made: Counts) -> list[str]:
    if made.median_s is None:
        return []
    return [
        f"Processor time of a scene: median {time(made.median_s)}, 95 % below {time(made.part_95_s)}, "
        f"at most {time(made.most_s)}."
    ]


def _finer(made: Counts) -> list[str]:
    if not made.finer_scenes and not made.finer_failed:
        return ["No scene was compared with a finer step."]
    return [
        f"{made.finer_scenes} scenes ran again at an eighth of the step; {made.finer_failed} more failed "
        f"there. {made.compared} quantities have an estimate, {made.unknown} have none. {made.above} "
        f"({_part(made.above, made.compared)}) are above {ABOVE:g} times their estimate, {made.far} above "
        f"{FAR:g} times. For {made.apart} of the {made.above} a run at a sixteenth does not agree with the "
        f"one at an eighth. Where both agree, {made.wrong} are above {FAR:g} times."
    ]


def _kinds(rows: list[CampaignRow]) -> list[str]:
    lines = [_line(("kind", "scenes", "result", "inaccurate", "none", "median time")), _line(("---",) * 6)]
    for kind in [*KINDS, *sorted({row.kind for row in rows} - set(KINDS))]:
        own = [row for row in rows if row.kind == kind]
        if own:
            made = counts(own)
            numbers = (made.scenes, made.ok, made.inaccurate, made.none)
            lines.append(_line((kind, *map(str, numbers), time(made.median_s))))
    return lines


def _groups(rows: list[CampaignRow], status: str) -> list[str]:
    groups = grouped(rows, status)
    if not groups:
        return ["None."]
    return [f"- {len(own)}: {_printed(reason)}: {_named(own)}" for reason, own in groups.items()]


def _off(rows: list[CampaignRow]) -> list[str]:
    lines = []
    for row in rows:
        for name, times in row.finer.above if row.finer else ():
            apart = ", the finer runs do not agree" if row.finer and name in row.finer.apart else ""
            lines.append(f"- {row.kind} {row.number}: {name}: {times:.3g} times its estimate{apart}")
        if row.finer and row.finer.failed:
            lines.append(f"- {row.kind} {row.number}: {_printed(row.finer.failed)}")
    return lines or ["None."]


def _named(rows: list[CampaignRow]) -> str:
    names = [f"{row.kind} {row.number}" for row in rows[:LISTED]]
    return ", ".join([*names, f"{len(rows) - LISTED} more"] if len(rows) > LISTED else names)


def _generator() -> list[str]:
    ranges = [_line(("value", "from", "to", "drawn")), _line(("---",) * 4)]
    for each in RANGES.values():
        ends = (f"{end:g} {each.unit}".strip() for end in (each.low, each.high))
        ranges.append(_line((each.meaning, *ends, "uniformly" if each.even else "logarithm")))
    stocks = [
        _line(("material", "share", "thickness", "density", "E_md", "E_cd / E_md", "length")),
        _line(("---",) * 7),
    ]
    for name, stock in STOCKS.items():
        pairs = (
            (stock.thickness, "mm"),
            (stock.density, "g/cm^3"),
            (stock.modulus, "MPa"),
            (stock.across, ""),
            (stock.length, "mm"),
        )
        cells = (f"{low:g} to {high:g} {unit}".strip() for (low, high), unit in pairs)
        stocks.append(_line((name, f"{100 * SHARES[name]:g} %", *cells)))
    kinds = [f"- `{name}`, {share:g} %: {_said(draw)}" for name, (share, draw) in KINDS.items()]
    return [GENERATOR, *ranges, "", SHEETS, *stocks, "", KINDS_HEAD, "", *kinds, ""]


def _said(kind: object) -> str:
    return " ".join((inspect.getdoc(kind) or "").split())


def _part(number: int, of: int) -> str:
    return f"{100.0 * number / of:.1f} %" if of else ""


def _printed(text: str) -> str:
    return printable(text).replace("|", "/").replace("\n", " ")


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"
