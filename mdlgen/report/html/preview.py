"""The page of a scene as it begins, without a run: its parts in space with names, and what they are."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

import numpy as np

from mdlgen.lints.cost import cost
from mdlgen.model.tables import Model
from mdlgen.paths import templates
from mdlgen.report import boxes
from mdlgen.report.animation import at_the_start, colour, packed
from mdlgen.report.arrows import BREADTH, arrows, longest
from mdlgen.report.begin import depths, known, met, of_no_part
from mdlgen.report.html.environment import environment, library, licences
from mdlgen.report.html.labels import labels
from mdlgen.report.over_time import after_comma
from mdlgen.report.sheets import parts_of_sheets

_SCRIPTS = ("drawing.js", "labels.js", "player.js", "preview.js")
PER_SECOND_SQUARED = 1000.0  # of mm/ms^2: m/s^2


def preview(model: Model, source: str = "") -> str:
    """The page; `source` is the text of the scene. The same Model gives the same text."""
    parts, contacts = known(model), met(model)
    keys, animation = _animation(model)
    drawn = {"animation": animation, "keys": keys, **labels(model)}
    for shown, part in zip(drawn["parts"], parts, strict=True):
        shown["contacts"] = [
            f"{row.other if row.one == part.name else row.one}: {row.says}"
            for row in contacts
            if part.name in (row.one, row.other)
        ]
        shown["lints"] = [f"{lint.code} {lint.message}; {lint.remedy}" for lint in part.lints]
    data = json.dumps(drawn, allow_nan=False, separators=(",", ":"))
    took = cost(model)
    folder = templates() / "report"
    return (
        environment()
        .get_template("preview.html.j2")
        .render(
            title=model.name,
            model={
                "analysis": model.run.analysis,
                "duration": model.run.duration,
                "boxes": boxes.count(model),
                "bushings": len(model.bushings),
                "pairs": len(model.pairs),
                "cost": None if took is None else str(took),
                "gravity": [float(g) * PER_SECOND_SQUARED for g in model.gravity],
                "gravity_profile": after_comma(model.gravity_profile),
            },
            parts=parts,
            contacts=contacts,
            lints=sum(len(part.lints) for part in parts) + len(of_no_part(model)),
            others=[asdict(lint) for lint in of_no_part(model)],
            source=source,
            # inside a script element nothing may look like markup
            data=data.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"),
            style=(folder / "style.css").read_text("utf-8"),
            library=library(figures=False),
            licences=licences(figures=False),
            scripts=[(folder / name).read_text("utf-8") for name in _SCRIPTS],
        )
    )


def _animation(model: Model) -> tuple[dict[str, list[tuple[str, float]]], dict[str, Any]]:
    """The drawing in space, and the meaning of parts of the ramp for colours that are not numbers."""
    keys, share = parts_of_sheets(model)
    thick = np.concatenate([sheet.thick for sheet in model.sheets])
    colours = [colour("sheet", "", share[None], (0.0, 1.0))]
    deep = np.maximum(depths(model), 0.0)
    if deep.max() > 0.0:
        colours.append(colour("depth", "mm", deep[None]))
    if np.ptp(thick) > 0.0:
        colours.append(colour("thickness", "mm", thick[None]))
    animation = at_the_start(model, colours)
    breadth = BREADTH * longest(model)
    for arrow in arrows(model):
        points, triangles = arrow.solid(breadth)
        animation["meshes"].append(
            {
                "name": arrow.part,
                "kind": arrow.kind,
                "says": arrow.says,
                "row": -1,
                "place": [0.0, 0.0, 0.0],
                "turn": [1.0, 0.0, 0.0, 0.0],
                "points": packed(points, "f4"),
                "triangles": packed(triangles, "u2"),
            }
        )
    return {"sheet": keys}, animation
