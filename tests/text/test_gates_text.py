"""Guides, planes and meshes that move, and stops, in text, deck and script."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from places import TESTS

from mdlgen.altair.moving import places
from mdlgen.altair.stops import stop_law, stopped
from mdlgen.errors import RefusedError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load, loads
from mdlgen.spec.scene import Scene
from mdlgen.verify.outcome import Verification
from mdlgen.verify.perturb import perturb
from mdlgen.verify.perturb.perturbations import Perturbation
from mdlgen.verify.solver_expressions import of_joint
from mdlgen.verify.verification import verify

OUTPUTS = ["motionview", "motionsolve", "msolve"]


def scene_of(*overrides: str) -> Scene:
    return loads((TESTS / "cases" / "gates.yaml").read_text(), "gates", overrides, folder=samples())


def test_motions_are_those_of_the_model_whatever_value_is_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Joints at pivots and along slides; the law of place at every corner and between them."""
    turn, own = perturb._Perturber.perturb, re.compile(r"ds_(bend|flap|floor|wedge)\.real_[atq]_\w")

    def of_gates(self: perturb._Perturber, perturbation: Perturbation) -> None:
        if own.fullmatch(perturbation.path):
            turn(self, perturbation)

    monkeypatch.setattr(perturb._Perturber, "perturb", of_gates)
    scene = scene_of()
    found = verify(scene, lower(scene))
    assert [str(d) for d in found.all_differences()] == []
    for kinds in found.kinds.values():
        assert kinds["motions"].entities == 4 and kinds["motions"].largest <= 1e-12
        assert kinds["joints"].entities == 4 and kinds["joints"].largest <= 1e-12
    assert found.perturbed is not None and found.perturbed.values == 17
    assert found.perturbed.largest <= 1e-12


def test_what_texts_are_compared_with_is_the_law_of_the_solvers() -> None:
    from mdlgen.mechanics.gate import course
    from mdlgen.mechanics.pack import Units, pack_bodies
    from mdlgen.mechanics.records import OF_BODY

    model, times = lower(scene_of()), np.linspace(0.0, 5.0, 41)
    rows = pack_bodies(model, np.dtype([*OF_BODY]), Units(), driven=True).view(np.recarray)
    for part, moving in model.gates:
        due = [course.py_func(rows[part.body], t).place for t in times.tolist()]
        assert places(moving, times) == pytest.approx(due, abs=1e-14)


def changed(scene: Scene, change: tuple[str, str, str], folder: Path) -> Verification:
    """What verify says of a text in which one place is replaced; `change`: output, pattern, replacement."""
    output, wrong, right = change
    text = emitter(output).emit(lower(scene))
    other = re.sub(wrong, right, text, count=1)
    assert other != text
    key, name = {
        "motionview": ("text", "m.mdl"),
        "motionsolve": ("deck", "m.xml"),
        "msolve": ("msolve", "m.py"),
    }[output]
    file = folder / name
    file.write_text(other)
    return verify(scene, lower(scene), perturb=False, **{key: file})


@pytest.mark.parametrize(
    ("output", "wrong", "right"),
    [
        ("motionview", r"(ds_bend\.real_q_2\.value\})-\(", r"\g<1>+("),
        ("motionsolve", r'(val_type +=) "D"', r'\g<1> "V"'),
        ("msolve", r"(\"along\": \[)0\.6, 0\.0, 0\.8", r"\g<1>0.8, 0.0, 0.6"),
    ],
)
def test_a_motion_that_is_changed_is_caught(output: str, wrong: str, right: str, tmp_path: Path) -> None:
    assert not changed(scene_of(), (output, wrong, right), tmp_path).ok


@pytest.mark.parametrize("output", OUTPUTS)
def test_the_diverter_is_written(output: str) -> None:
    text = emitter(output).emit(lower(load(samples() / "diverter.yaml")))
    assert "STEP(TIME," in text


def free_scene(*overrides: str) -> Scene:
    return loads((TESTS / "cases" / "stops.yaml").read_text(), "stops", overrides, folder=samples())


def test_what_forces_move_is_that_of_the_model_whatever_value_is_changed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Mass and inertia of what turns and slides, springs, and the law of stops over place and rate; those of
    a press and an arm, too."""
    turn = perturb._Perturber.perturb
    own = re.compile(r"ds_(?!note)\w+\.real_(e_lo|e_hi|[IMcfk]_[eqca]|start|g_\w|M)")

    def of_stops(self: perturb._Perturber, perturbation: Perturbation) -> None:
        if own.fullmatch(perturbation.path):
            turn(self, perturbation)

    monkeypatch.setattr(perturb._Perturber, "perturb", of_stops)
    scene = free_scene()
    found = verify(scene, lower(scene))
    assert [str(d) for d in found.all_differences()] == []
    for kinds in found.kinds.values():
        assert kinds["stops"].entities == 5 and kinds["stops"].largest <= 1e-12
        assert kinds["bushings"].entities == 3 and kinds["bodies"].largest <= 1e-12
    assert found.perturbed is not None and found.perturbed.values >= 40
    assert found.perturbed.largest <= 1e-12


def test_the_law_of_stops_is_that_of_the_solvers() -> None:
    from mdlgen.mechanics.gate import BLUNT, stop
    from mdlgen.mechanics.pack import Units, pack_bodies
    from mdlgen.mechanics.records import OF_BODY

    model = lower(free_scene())
    rows = pack_bodies(model, np.dtype([*OF_BODY]), Units(), driven=True).view(np.recarray)
    bodies = {part.name: part.body for part in model.machine}
    for one in stopped(model, BLUNT):
        row, (low, high) = rows[bodies[one.name]], one.ends
        law = stop_law(
            *("AZ(i,j)", "WZ(i,j,j)", (repr(low), repr(high))),
            *map(repr, (one.stops.stiffness, one.share, one.blunt)),
        )
        for place in (low - 0.1, low - 1e-3, 0.5 * (low + high), high + 1e-3, high + 0.1):
            for rate in (-10.0, -1e-4, 0.0, 1e-5, 10.0):
                (found,) = of_joint(law, [(place, rate)])
                assert found == pytest.approx(stop.py_func(row, place, rate).force, rel=1e-10, abs=1e-12)


@pytest.mark.parametrize(
    ("output", "wrong", "right"),
    [
        ("motionview", r"(frc_swung_stops, LIN.*\n.*?e_lo.value\}\))\*PI", r"\g<1>*2*PI"),
        ("motionsolve", r'(tz_expression +=) "900\.0', r'\g<1> "901.0'),
        ("msolve", r"(\"share\": )0\.6", r"\g<1>0.7"),
    ],
)
def test_a_stop_that_is_changed_is_caught(output: str, wrong: str, right: str, tmp_path: Path) -> None:
    assert not changed(free_scene(), (output, wrong, right), tmp_path).ok


@pytest.mark.parametrize("output", OUTPUTS)
def test_an_inertia_that_no_mass_has_is_refused_by_name(output: str) -> None:
    model = lower(free_scene("guides.flap.pivot.inertia=5 g*mm^2"))
    with pytest.raises(RefusedError, match="flap has an inertia of 5") as error:
        emitter(output).emit(model)
    assert error.value.path == ("guides", "flap", "pivot", "inertia")
