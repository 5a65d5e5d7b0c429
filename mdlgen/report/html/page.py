"""report.html: one or more runs in a page that stands alone, read from file:// as well as from a mail."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.checks import lints
from mdlgen.model.parts.kinds import KINDS
from mdlgen.report import boxes
from mdlgen.report.animation import animation, frames, packed
from mdlgen.report.figures.maps import Map, maps
from mdlgen.report.html.curves import Panel, panels
from mdlgen.report.html.differences import differences
from mdlgen.report.html.environment import environment, library, licences, scripts, style
from mdlgen.report.html.labels import labels
from mdlgen.report.over_time import after_comma
from mdlgen.report.sheets import parts_of_sheets
from mdlgen.results.result import Result
from mdlgen.results.strain import histories

if TYPE_CHECKING:
    from mdlgen.model.tables import Ints, Model
    from mdlgen.results.recorded.against import Against

_CORNERS = "%.3f,%.3f %.3f,%.3f %.3f,%.3f %.3f,%.3f"  # of a cell
_STEPS = 18  # of colour in a map: .c0 to .c18 in style.css
_SCRIPTS = ("drawing.js", "charts.js", "labels.js", "player.js", "play.js", "page.js")


def page(results: Sequence[Result], names: Sequence[str] = (), against: Against | None = None) -> str:
    """The page of one run, or of several side by side; `names` are what they are called, else A, B, ...
    `against` is how far the first one is from what another program recorded.

    The same results give the same text. Every name and text of a scene is escaped.
    """
    names = list(names) or [chr(ord("A") + k) for k in range(len(results))]
    runs = [run_record(result, name) for result, name in zip(results, names, strict=True)]
    beside: dict[str, Any] | None = None
    if against is not None:
        from mdlgen.report.html import recorded

        runs[0]["drawn"]["panels"] = [*map(_panel, recorded.panels(against)), *runs[0]["drawn"]["panels"]]
        rows = [recorded.row(apart) for apart in against.quantities]
        beside = {"rows": rows, "sentences": recorded.sentences(against)}
    drawn = json.dumps([run.pop("drawn") for run in runs], allow_nan=False, separators=(",", ":"))
    return (
        environment()
        .get_template("page.html.j2")
        .render(
            title=" / ".join(dict.fromkeys(run["summary"]["scene"] for run in runs)),
            runs=runs,
            differences=differences(results, names, [run["summary"] for run in runs])
            if len(runs) > 1
            else None,
            recorded=beside,
            # inside a script element nothing may look like markup
            data=drawn.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"),
            style=style(),
            library=library(),
            licences=licences(),
            scripts=scripts(_SCRIPTS),
        )
    )


def prepare(model: Model) -> None:
    """Loads the modules for the page, and computes all that does not depend on the run."""
    environment().get_template("page.html.j2")
    for read in (library, licences, style, partial(scripts, _SCRIPTS)):
        read()
    lints(model)


def run_record(result: Result, name: str, draft: Ints | None = None) -> dict[str, Any]:
    """The record of a run for the template, with the data of the scripts under `drawn`.

    `draft`: the stored states to draw of a run that another one soon replaces; it has no maps of the loads of
    each joint.
    """
    at = frames(result) if draft is None else draft
    joints = histories(result, at)
    force, deep = boxes.contact(result, at)
    strain, curvature = boxes.greatest(joints, force.shape)
    colours = {
        "speed": ("mm/s", boxes.speed(result, at)),
        "strain": ("", strain),
        "curvature": ("1/mm", curvature),
        "contact": ("N", force),
    }
    keys = {}
    if any(sheet.zones for sheet in result.model.sheets):
        keys["zones"], share = parts_of_sheets(result.model)
        colours["zones"] = ("", share[None])
    summary = result.summary()
    return {
        "name": name,
        "author": result.model.author,
        "revision": result.model.revision,
        "ran_at": result.ran_at,
        "summary": summary,
        "model": {
            "gravity": [float(v) * 1000.0 for v in result.model.gravity],
            "gravity_profile": after_comma(result.model.gravity_profile),
            "analysis": result.model.run.analysis,
            "boxes": sum(sheet.count for sheet in result.model.sheets),
            "bushings": len(result.model.bushings),
            "parts": {
                "sheets": len(result.model.sheets),
                **{kind.table: len(result.model.parts_of(kind.part)) for kind in KINDS},
                "contacts": len(result.model.contacts),
                "probes": len(result.model.probes),
            },
        },
        "parameters": result.model.parameters,
        "source": result.source,
        "maps": [_map(found) for found in maps(result)] if draft is None else [],
        "lints": lints(result.model),
        "drawn": {
            "name": name,
            "scene": summary["scene"],
            "animation": animation(result, at, colours, names=frozenset(keys)),
            "keys": keys,
            "panels": [_panel(panel) for panel in panels(result, at, deep, joints)],
            **labels(result.model),
        },
    }


def _map(found: Map) -> dict[str, Any]:
    """A map as the template draws it [mm], y downwards; the colours are steps of its style."""
    corners = (found.cells * (1.0, -1.0)).reshape(len(found.cells), -1)
    return {
        "title": found.title.split("\n"),
        "size": found.sheet.outline,
        "ring": (found.place * (1, -1)).tolist() if found.parts.any() else None,
        # whole elements of numbers: a template takes longer for so many
        "cells": "\n".join(
            f'<polygon class="c{round(_STEPS * part)}" points="{_CORNERS % tuple(cell)}"/>'
            for cell, part in zip(corners.tolist(), found.parts.tolist(), strict=True)
        ),
    }


def _panel(panel: Panel) -> dict[str, Any]:
    lines = [
        {"name": line.name, "x": packed(line.x, "f4"), "y": packed(np.nan_to_num(line.y), "f4")}
        for line in panel.lines
    ]
    return {**vars(panel), "short": panel.short or panel.key, "lines": lines}
