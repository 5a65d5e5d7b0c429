"""Texts that a reviewer has read: whole ones, and each template on its own with all of its branches."""

from __future__ import annotations

import json
import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from base import BASE
from golden import compare
from places import GOLDEN
from template_scenes import C2C, PARTS

import mdlgen.backends.motionview as motionview
from mdlgen.backends.motionview.writer.banner import banner
from mdlgen.backends.motionview.writer.contacts import force_views
from mdlgen.backends.motionview.writer.environment import environment
from mdlgen.backends.motionview.writer.views import scene_view
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples, templates
from mdlgen.spec.load import load, loads

# What the sections of a template are about; the others are about the scene as a whole.
LOOPED = {
    "sheet_data.mdl.j2": "sheets",
    "sheet.mdl.j2": "sheets",
    "support.mdl.j2": "supports",
    "load.mdl.j2": "loads",
    "roller.mdl.j2": "rollers",
    "plane.mdl.j2": "planes",
    "guide.mdl.j2": "guides",
    "mesh.mdl.j2": "meshes",
    "probe.mdl.j2": "probes",
    "force.mdl.j2": "forces",
}
MACHINE = ("rollers", "planes", "guides", "meshes")
# Their text stands in the goldens of those that take them in.
WITHIN = tuple(
    f"{name}.mdl.j2"
    for name in ("bend", "cells", "contact_commands", "law", "lengths", "macros", "moving", "notes")
)
WITH_SET_CONTACT = ("contacts.mdl.j2",)


def small_model(*overrides: str) -> Model:
    return lower(loads(json.dumps(BASE), overrides=overrides, folder=samples()))


def rendered(template: str, model: Model) -> str:
    """What a template makes of a model."""
    if template == "companion.py.j2":
        return motionview.companion(model, only="sheets" if model.externals else None) or ""
    if template == "system.mdl.j2":
        return motionview.emit(model, only="sheets")
    if template == "model.mdl.j2":
        return motionview.emit(model, forces=True)
    scene = scene_view(model, template in WITH_SET_CONTACT)
    scene = replace(scene, forces=force_views(model, scene.pairs))
    context: dict[str, Any] = {"scene": scene, "banner": banner(model, scene)}
    part = environment().get_template(template)
    if template not in LOOPED:
        return part.render(context)
    kind = LOOPED[template]
    name = "part" if kind in MACHINE else kind.removesuffix("s")
    return "\n".join(part.render(context, **{name: item}) for item in getattr(scene, kind))


def part_text(template: str) -> str:
    """All sections of a template, each under its title."""
    mark = "#" if template.startswith("companion") else "//"
    sections = PARTS[template].items()
    return "\n".join(f"{mark} ==== {title}\n{rendered(template, small_model(*o))}" for title, o in sections)


WHOLE = {
    "transport_4x4_e2e_2x3.mdl": ("sheets.note.boxes=[2,3]",),
    "transport_4x4_c2c_2x3.mdl": ("sheets.note.boxes=[2,3]", C2C, 'sheets.note.turn="10 deg"'),
    "transport_4x4.mdl": (),
}


@pytest.mark.parametrize("name", sorted(WHOLE))
def test_golden(name: str) -> None:
    model = lower(load(samples() / "transport_4x4.yaml", WHOLE[name]))
    compare(motionview.emit(model), GOLDEN / name)


@pytest.mark.parametrize("template", sorted(PARTS))
def test_golden_part(template: str) -> None:
    # a name that no tool takes for a whole .mdl or for Python code
    compare(part_text(template), GOLDEN / "parts" / f"{template.removesuffix('.j2')}.txt")


def test_every_template_has_a_golden() -> None:
    found = {path.name for path in (templates() / "motionview").iterdir()}
    assert found == {*PARTS, *WITHIN}


def _writing_lines(template: str) -> set[int]:
    """Lines that write text, in the Python code that a template is compiled to."""
    made = environment()
    assert made.loader is not None
    source, file, _ = made.loader.get_source(made, template)
    code = made.compile(source, template, file, raw=True)
    words = re.compile(r" *(yield |t_\d+\.(append|extend)\()")
    return {number for number, line in enumerate(code.splitlines(), 1) if words.match(line)}


def test_every_branch_of_the_templates_stands_in_a_golden() -> None:
    """Each line that can write text does so while the goldens are made."""
    environment.cache_clear()  # what a template imports runs once in an environment
    ran: dict[str, set[int]] = {}

    def trace(frame: Any, event: str, _: Any) -> Any:
        file = frame.f_code.co_filename
        if not file.endswith(".j2"):
            return None
        ran.setdefault(Path(file).name, set()).add(frame.f_lineno)
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        for template in PARTS:
            part_text(template)
    finally:
        sys.settrace(before)
    for name in (*PARTS, *WITHIN):
        template = environment().get_template(name)
        missed = sorted(template.get_corresponding_lineno(k) for k in _writing_lines(name) - ran[name])
        assert not missed, f"{name}: no golden shows what stands after lines {missed}"
