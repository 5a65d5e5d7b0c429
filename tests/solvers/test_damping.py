"""Damping as a property of the paper: by a time, or a loss factor; law, decay, creep, in both solvers.

Closed forms: a mode of angular frequency omega of a Kelvin-Voigt body decays with the damping ratio
zeta = omega tau/2, half of its loss factor omega tau (Nashif, Jones and Henderson, Vibration Damping, 1985,
chapter 2; Cremer, Heckl and Petersson, Structure-Borne Sound, section 3.3), on any grid.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from damped import CANTILEVER, damped, model

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.lowering.stiffness import damping_times
from mdlgen.model.tables import CLAMP, JOINT_X, JOINT_Y, SUPPORT
from mdlgen.spec.load import load
from mdlgen.spec.schema import json_schema
from mdlgen.verify.verification import verify

LAYOUTS = ("edge_to_edge", "center_to_center", "plate")


# ---------------------------------------------------------------- what a scene may say


@pytest.mark.parametrize(
    ("text", "where", "message"),
    [
        (
            "{time: 0.1 ms, ratio: 0.1}",
            "damping:",
            "damping by ratio, time: give time, or loss_factor with at",
        ),
        ("{time: 0.1 ms, rotation: paper}", "damping:", "damping by rotation, time"),
        ("{time: 0.1 ms, loss_factor: 0.1, at: 1 Hz}", "damping:", "damping by time, loss_factor, at"),
        ("{loss_factor: 0.1}", "damping:", "loss_factor needs at, as at: 40 Hz"),
        ("{at: 40 Hz}", "damping:", "at needs loss_factor, as loss_factor: 0.05"),
        ("{loss_factor: 0.1, at: 0 Hz}", "damping.at:", "more than 0 Hz"),
        ("{loss_factor: 11, at: 1 Hz}", "damping.loss_factor:", "11 is outside what is allowed: 0 to 10"),
        ("{loss_factor: [0.1, x], at: 1 Hz}", "damping.loss_factor.1:", "'x' is not a number"),
        ("{time: 1}", "damping.time:", "1 has no unit"),
        ("{time: -1 ms}", "damping.time:", "at least 0 ms"),
        ("{time: [1 ms]}", "damping.time:", "a list of two, MD and CD; got a list of 1"),
        ("{time: [1 ms, 3 Hz]}", "damping.time.1:", "wrong unit; expected a unit like 'ms'"),
    ],
)
def test_what_a_damping_cannot_be(text: str, where: str, message: str) -> None:
    with pytest.raises(SpecError) as error:
        model(damped(text))
    line = str(error.value)
    assert f"materials.eur10.{where}" in line and message in line and "\n" not in line


def test_one_form_takes_the_place_of_the_other() -> None:
    base = "materials.eur10.damping"
    timed = model(f"{base}.time=0.1 ms")
    assert timed.sheets[0].damping_times == (0.1, 0.1) and timed.sheets[0].rotation_damping == "time"
    lost = model(f"{base}.time=0.1 ms", f"{base}.loss_factor=[0.05, 0.1]", f"{base}.at=40 Hz")
    eta = 2 * math.pi * 0.04  # 40 Hz in rad/ms
    assert lost.sheets[0].damping_times == pytest.approx((0.05 / eta, 0.1 / eta), rel=1e-15)
    back = model(f"{base}.time=0.1 ms", f"{base}.ratio=0.12", f"{base}.ratio_ty=0.04")
    assert np.array_equal(back.bushings.c, model().bushings.c)
    assert back.sheets[0].damping_times is None


def test_the_schema_says_it() -> None:
    record = json_schema()["$defs"]["Damping"]["properties"]
    assert set(record) == {"ratio", "ratio_ty", "rotation", "time", "loss_factor", "at"}
    assert "tau_md" in record["time"]["description"] and "0.12" in record["ratio"]["description"]
    one, two = (
        record["time"]["anyOf"][0]["anyOf"]
        if "anyOf" in record["time"]["anyOf"][0]
        else record["time"]["anyOf"][:2]
    )
    assert one["type"] == "string" and two["maxItems"] == 2


# ---------------------------------------------------------------- the law of a joint


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("twist", [False, True])
def test_each_component_has_the_time_of_what_it_follows_from(layout: str, twist: bool) -> None:
    """c = tau k on every bushing: clamp hinges, zones, creases and lengths of their own included."""
    if twist and layout == "edge_to_edge":
        pytest.skip("it has no twist of its own")
    sets = (
        f"sheets.note.layout={layout}",
        "sheets.note.boxes=[4,6]",
        "sheets.note.zones={a: {x: [-30 mm, -8 mm], y: [-60 mm, 20 mm], thickness: 0.15 mm, stiffness: 2}}",
        "sheets.note.grading={y: {sizes: [1, 2, 1, 1, 3, 1]}}",
        "sheets.note.shape={folds: [{along: x, at: 0 mm, angle: 5 deg, stiffness: 0.5}]}",
        'supports=[{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
        *(["materials.eur10.D_twist=0.1 N*mm"] if twist else []),
    )
    made = model(*sets, damped("{time: [0.1 ms, 0.4 ms]}"))
    rows = made.bushings
    md, cd, mean = 0.1, 0.4, 0.25
    along_x = [md, cd, mean, cd, md, mean]  # k_x of E_md, k_y of E_cd, k_tx of D_cd, k_ty of D_md
    along_y = list(along_x)
    if twist or layout == "plate":
        along_x[3] = along_y[4] = mean
    if layout == "plate":  # shear of G, bending in the plane as the strip stretches
        along_x[1] = along_y[0] = mean
        along_x[5], along_y[5] = md, cd
    for kinds, tau in (((JOINT_X,), along_x), ((JOINT_Y, CLAMP), along_y)):
        mine = np.isin(rows.kind, kinds)
        assert mine.any()
        assert np.allclose(rows.c[mine], np.array(tau) * rows.k[mine], rtol=1e-14)
    held = rows.kind == SUPPORT  # a machine's part, no paper: as before
    assert held.any() and np.array_equal(rows.c[held], model(*sets).bushings.c[held])


def test_the_mean_is_that_of_complex_moduli() -> None:
    """Where G goes with sqrt(E_md E_cd), so it does with E (1 + i omega tau): its loss factor is the mean."""
    omega, md, cd = 1e-3, 0.1, 0.7
    g = np.sqrt(complex(1, omega * md) * complex(1, omega * cd))
    mean = damping_times((md, cd), True, True, True)[1]
    assert g.imag / g.real == pytest.approx(omega * mean, rel=1e-6)
    # the geometric mean, 0.265, is not
    assert g.imag / g.real != pytest.approx(omega * math.sqrt(md * cd), rel=0.3)


def test_the_derived_table_and_its_text() -> None:
    from mdlgen.report.overview import overview
    from mdlgen.report.text import overview_text

    made = model(damped("{time: [0.1 ms, 0.2 ms]}"))
    record = overview(made)["sheets"]["note"]["derived"]
    assert (record["tau_md"], record["tau_cd"]) == (0.1, 0.2)
    assert record["c_ty"] == pytest.approx(0.1 * record["k_ty"]) and record["c_x"] == pytest.approx(
        0.1 * record["k_x"]
    )
    assert "damping time MD 0.1 ms, CD 0.2 ms" in overview_text(overview(made))
    assert "tau_md" not in overview(model())["sheets"]["note"]["derived"]


def test_a_curve_damps_by_its_first_slope(tmp_path) -> None:
    curve = "materials.eur10.curve_md={points: [[0, 0 MPa], [0.01, 30 MPa], [0.02, 40 MPa]]}"
    made = model(curve, damped("{time: 0.2 ms}"), "sheets.note.boxes=[4,4]")
    joints = made.bushings.kind == JOINT_X
    first = made.curves.slope[0] * made.curves.area[joints] / made.curves.length[joints]
    assert np.allclose(made.bushings.c[joints, 0], 0.2 * first, rtol=1e-12)


# ---------------------------------------------------------------- the texts


FORMS = ("{time: 0.1 ms}", "{time: [0.1 ms, 0.3 ms]}", "{loss_factor: 0.05, at: 40 Hz}")
UNLIKE = {
    "alike": (),
    "zone": (
        "sheets.note.zones={a: {x: [-33 mm, -10 mm], y: [-60 mm, 0 mm], thickness: 0.15 mm, stiffness: 1.3}}",
    ),
    "fold": ("sheets.note.shape={folds: [{along: y, at: 0 mm, angle: 5 deg, stiffness: 0.5}]}",),
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("form", [*FORMS, "{loss_factor: [0.05, 0.02], at: 40 Hz}"])
@pytest.mark.parametrize("unlike", UNLIKE)
def test_the_text_says_the_same_and_follows_its_values(layout: str, form: str, unlike: str) -> None:
    """Read back and evaluated; and each of its values turned, tau, eta and f among them."""
    twist = () if layout == "edge_to_edge" else ("materials.eur10.D_twist=0.1 N*mm",)
    sets = ("sheets.note.boxes=[2,4]", f"sheets.note.layout={layout}", damped(form), *UNLIKE[unlike], *twist)
    scene = load(CANTILEVER, sets)
    found = verify(scene, lower(scene))
    assert found.ok, [str(d) for d in found.all_differences()[:3]]
    names = {p.member for p in lower(scene).parameters} & {"tau", "tau_md", "eta", "eta_md", "f", "zeta"}
    assert "zeta" not in names and names


def test_one_value_moves_every_damping_of_the_text() -> None:
    text = mdlgen.emit(model("sheets.note.boxes=[2,4]", damped("{time: 0.1 ms}")), "motionview")
    assert "*SetReal( ds_note.real_tau, 0.0001 )" in text
    assert 'real_tau, "Damping time tau (s)", EDIT' in text
    for name in ("x", "y", "z", "tx", "ty", "tz"):
        assert (
            f"*SetReal( ds_note.real_c_{name}, ds_note.real_tau.value*ds_note.real_k_{name}.value )" in text
        )
    assert "zeta" not in text and "real_J_x" not in text


# ---------------------------------------------------------------- lints


@pytest.mark.parametrize(
    ("sets", "code", "where"),
    [
        ([damped("{time: 5 ms}")], "W130", "materials.eur10.damping.time"),
        ([damped("{time: [0.1 ms, 2 us]}")], "W130", "materials.eur10.damping.time"),
        ([damped("{loss_factor: 0.5, at: 1 Hz}")], "W130", "materials.eur10.damping.loss_factor"),
        (
            [damped("{time: 0.5 ms}"), "run={analysis: transient, duration: 0.4 ms}"],
            "W131",
            "materials.eur10.damping.time",
        ),
        (
            [damped("{time: 200 ms}"), "run={analysis: transient, duration: 1 s}"],
            "W132",
            "materials.eur10.damping.time",
        ),
    ],
)
def test_lints(sets: list[str], code: str, where: str) -> None:
    hits = [lint for lint in lints(model(*sets)) if lint.code == code]
    assert [lint.where for lint in hits][:1] == [where]
    assert all(str(lint).isascii() and "\n" not in str(lint) for lint in hits)


def test_no_lint_of_a_paper() -> None:
    run = "run={analysis: transient, duration: 400 ms}"
    assert lints(model(damped("{time: 0.1 ms}"), run)) == []
    assert lints(model(damped("{loss_factor: 0.05, at: 40 Hz}"), run)) == []
    # 1.855428 Hz (oracles) swings up to a time of 2/omega, 171.6 ms; along x the free ends swing faster
    below, above = (
        {
            x.message.split(" along ")[1][:1]
            for x in lints(model(damped(f"{{time: {t} ms}}"), run))
            if x.code == "W132"
        }
        for t in (171, 172)
    )
    assert above - below == {"y"}


# ---------------------------------------------------------------- decay


# ---------------------------------------------------------------- creep: E (strain + tau rate) is the stress


# ---------------------------------------------------------------- what is lost, and to what
