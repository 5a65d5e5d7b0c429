"""Motors, bearings, torque limiters and shafts of prescribed speed in text, deck and script."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from places import TESTS
from verified import check

from mdlgen.errors import RefusedError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.load import load
from mdlgen.verify.perturb import perturb
from mdlgen.verify.perturb.perturbations import Perturbation

MOTORS = TESTS / "cases" / "motors.yaml"
OUTPUTS = ["motionview", "motionsolve", "msolve"]


def model_of(*overrides: str) -> Model:
    return lower(load(MOTORS, overrides))


def test_torques_are_those_of_the_model_whatever_value_is_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Six laws at some thirty points of time and spin, the inertia with the rotor, the spin at the start."""
    turn, own = perturb._Perturber.perturb, re.compile(r".*real_(T|w|J|g|u|t|d|ratio)_?[a-z\d]*")

    def of_axles(self: perturb._Perturber, perturbation: Perturbation) -> None:
        path = perturbation.path
        if own.fullmatch(path) and "ds_note" not in path and not path.endswith(("_touch", "real_w")):
            turn(self, perturbation)

    monkeypatch.setattr(perturb._Perturber, "perturb", of_axles)
    found = check(MOTORS)
    assert [str(d) for d in found.all_differences()] == []
    for kinds in found.kinds.values():
        assert kinds["axles"].entities == 6 and kinds["motions"].entities == 1
        assert kinds["axles"].largest <= 1e-12 and kinds["velocities"].entities == 3
    assert found.perturbed is not None and found.perturbed.values >= 30 and found.perturbed.largest <= 1e-12


@pytest.mark.parametrize(
    ("output", "wrong"),
    [
        ("motionview", r"(frc_line_axle, LIN.*\n.*)\{ds_line.real_w_n.value\}-"),
        ("motionsolve", r"(tz_expression += \"6.0\*)STEP\(-"),
        ("msolve", r"(\"limiter\": \{\"torque\": )6.0"),
    ],
)
def test_a_torque_that_is_changed_is_caught(output: str, wrong: str, tmp_path: Path) -> None:
    text = emitter(output).emit(model_of())
    changed = re.sub(
        wrong, {"msolve": r"\g<1>7.0", "motionsolve": r"\g<1>STEP("}.get(output, r"\g<1>"), text, count=1
    )
    assert changed != text
    file = tmp_path / {"motionview": "m.mdl", "motionsolve": "m.xml", "msolve": "m.py"}[output]
    file.write_text(changed)
    key = {"motionview": "text", "motionsolve": "deck", "msolve": "msolve"}[output]
    assert not check(MOTORS, perturb=False, **{key: file}).ok


@pytest.mark.parametrize("name", ["stall", "retard"])
@pytest.mark.parametrize("output", OUTPUTS)
def test_samples_with_motors_and_limiters_are_written(name: str, output: str) -> None:
    text = emitter(output).emit(lower(load(samples() / f"{name}.yaml")))
    assert re.search(r"frc_(retard|brake)_axle|\"torques\"", text)


@pytest.mark.parametrize(
    ("override", "path", "what"),
    [
        (
            "rollers.twin.drive={speed: 9 rad/s, motor: {torque: 1 N*mm, speed: 10 rad/s, "
            "control: {proportional: 1 N*mm*ms/rad}}}",
            ("rollers", "twin", "drive", "motor", "control"),
            "speed control",
        ),
        (
            "rollers.twin.drive={speed: 9 rad/s, motor: {torque: 1 N*mm, steps: {}}}",
            ("rollers", "twin", "drive", "motor", "steps"),
            "stepper",
        ),
        ("shafts.main={rollers: {twin: 2, held: 1}}", ("shafts", "main"), "shaft main, which couples held"),
    ],
)
@pytest.mark.parametrize("output", OUTPUTS)
def test_what_has_no_form_is_refused_by_name(
    override: str, path: tuple[str, ...], what: str, output: str
) -> None:
    others = ["shafts={}"] if "twin.drive" in override else ["rollers.held={}"]
    with pytest.raises(RefusedError, match=what) as error:
        emitter(output).emit(model_of(*others, override))
    assert error.value.path == path
