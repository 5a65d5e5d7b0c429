"""What the MotionView text cannot say: what is refused, and what the companion script sets."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import replace

import pytest
from written import Text, model_of

import mdlgen.backends.motionview as motionview
from mdlgen.errors import RefusedError

SMALL = "sheets.note.boxes=[3,4]"


def test_a_spring_shorter_than_its_compression_is_refused_by_name():
    model = model_of("transport_4x4.yaml", SMALL)
    roller = next(r for r in model.rollers if r.press is not None)
    assert roller.press is not None
    far = replace(
        roller, press=replace(roller.press, start=roller.press.touch - 2 * roller.press.free_length)
    )
    with pytest.raises(RefusedError, match=roller.name):
        motionview.check(model.with_parts([far]))


def test_static_analysis_writes_a_static_command():
    at_rest, *_ = _commands(model_of("cantilever.yaml"))
    assert (at_rest["command"], at_rest["method"], at_rest["max_imbalance"]) == (
        "Param_Static",
        "FIM_D",
        "0.0001",
    )
    assert [c["command"] for c in _commands(model_of("cantilever.yaml"))] == [
        "Param_Static",
        "Simulate",
        "Stop",
    ]
    touching = _commands(model_of("transport_4x4.yaml", SMALL, "run.analysis=static"))
    assert touching[0]["method"] == "MKEAM" and "max_imbalance" not in touching[0]


def test_a_text_has_the_steps_and_times_of_its_run():
    steps, simulate, _ = _commands(model_of("transport_4x4.yaml", SMALL))
    assert (steps["command"], steps["integrator_type"], steps["integr_tol"]) == (
        "Param_Transient",
        "DSTIFF",
        "0.001",
    )
    assert (steps["h_max"], steps["h_min"]) == ("1e-05", "1e-07")  # the paper's 10 us
    assert (simulate["end_time"], simulate["print_interval"]) == ("0.05", "0.00025")
    fine = _commands(
        model_of("transport_4x4.yaml", SMALL, 'run.step="0.7 us"', 'run.duration="10.123456789 ms"')
    )
    assert float(fine[0]["h_max"]) == pytest.approx(7e-7, rel=1e-14)
    assert fine[1]["end_time"] == "0.010123456789"  # by itself Templex prints six digits


def _commands(model):
    commands = Text(motionview.emit(model)).values["commands"]["tmplt_run"]
    return [command for command in commands if command["command"] != "Force_Contact"]


def test_a_text_has_gravity_and_units():
    standard = Text(motionview.emit(model_of("verify/incline.yaml"))).values["standard"]
    assert standard["gravity"] == {"op_gravity": "On", "igrav": 3355.2176, "jgrav": 0.0, "kgrav": -9218.3846}
    assert list(standard["units"].values()) == ["NEWTON", "MILLIMETER", "KILOGRAM", "SECOND"]
    still = Text(motionview.emit(model_of("cantilever.yaml", 'gravity=["0 m/s^2","0 m/s^2","0 m/s^2"]')))
    assert still.values["standard"]["gravity"]["kgrav"] == 0.0


def _run_script(script: str, values: Mapping[str, float] | None = None, by_name: bool = False) -> dict:
    """Runs a companion with a stand-in for MotionView that has `values`; numbers by contact. `by_name`: a
    version that finds children with getChild, and has no attributes for them."""
    tree = ast.parse(script)
    tree.body = [n for n in tree.body if not isinstance(n, ast.ImportFrom)]
    children: dict[str, dict] = {}
    there = values or {}

    class Entity:
        def __init__(self, name):
            self.name = name

        def __getattr__(self, member):
            if f"{self.name}.{member}" not in there:
                raise AttributeError(member)
            return type("Real", (), {"value": there[f"{self.name}.{member}"]})

        def setValues(self, force_loc, **numbers):
            assert force_loc == "NODE"
            children.setdefault(self.name, {}).update(numbers)

    class Root:
        def __getattr__(self, name):
            if by_name:
                raise AttributeError(name)
            return Entity(name)

    class Finding(Root):
        def getChild(self, name):
            return Entity(name)

    root = Finding() if by_name else Root()
    space = {"mview": type("mview", (), {"getModel": staticmethod(lambda: root)}), "print": lambda *a: None}
    exec(compile(tree, "companion", "exec"), space)
    return children


def test_companion_sets_every_contact():
    smooth, rough = "contacts.6.friction=0", "contacts.4.friction={static: 0.9, dynamic: 0.7}"
    model = model_of("transport_4x4.yaml", SMALL, smooth, rough)
    script = motionview.companion(model)
    assert script is not None and script.isascii()
    assert motionview.companion_reasons(model) == []  # the solver commands say it
    numbers = _run_script(script)
    assert _run_script(script, by_name=True) == numbers
    smoothing = model.contacts.smoothing[-1] * 1000
    text = Text(motionview.emit(model))
    assert set(numbers) == set(text.values["contacts"])
    expected = {"penalty": 100.0, "rest_coeff": 0.5, "normal_trans_vel": smoothing}
    assert numbers["con_note_0_0_support"] == expected
    assert text.values["contacts"]["con_note_0_0_support"]["friction"] == "OFF"
    driven = next(v for k, v in numbers.items() if k.startswith("con_note_") and "motor" in k)
    assert (driven["penalty"], driven["mu_static"], driven["mu_dynamic"]) == (300.0, 0.9, 0.7)


def test_companion_is_left_out_where_it_is_not_needed():
    model = model_of("cantilever.yaml")
    assert motionview.companion(model) is None
    assert motionview.companion_reasons(model) == []
    default = tuple(f'contacts.{k}.smoothing="1 mm/s"' for k in range(7))
    contacts = model_of("transport_4x4.yaml", SMALL, *default)
    assert motionview.companion(contacts, set_contact=True) is None
    smooth = model_of("transport_4x4.yaml", SMALL, *default, 'contacts.0.smoothing="0.1 mm/s"')
    assert any("normal_trans_vel" in r for r in motionview.companion_reasons(smooth, set_contact=True))
    numbers = _run_script(motionview.companion(smooth, set_contact=True) or "")
    assert numbers["con_motor_1_left_counter_1_left"] == {"normal_trans_vel": 0.1}


def test_solver_commands_give_every_contact_its_numbers_and_its_master():
    zone = {
        "sheets.note.boxes": "[4,6]",
        "sheets.note.zones": "{tape: {x: [-33.5 mm, 0 mm], y: [-63.5 mm, 63.5 mm], friction: 0.5}}",
    }
    model = model_of("transport_4x4.yaml", *(f"{k}={v}" for k, v in zone.items()), "contacts.6.friction=0")
    text = Text(motionview.emit(model))
    commands = [c for c in text.values["commands"]["tmplt_run"] if c["command"] == "Force_Contact"]
    assert {c["id"] for c in commands} == set(text.values["contacts"]) and len(commands) == len(model.pairs)
    by_id = {c["id"]: c for c in commands}
    for name, command in by_id.items():
        assert ("mu_static" in command) == (text.values["contacts"][name]["friction"] == "ON")
    assert by_id["con_motor_1_left_counter_1_left"]["penalty"] == "30.5"
    assert "master_surface" not in by_id["con_motor_1_left_counter_1_left"]
    assert {c["master_surface"] for n, c in by_id.items() if "note" in n and "support" not in n} == {"J"}
    assert {c["mu_static"] for n, c in by_id.items() if "note" in n and "motor" in n} == {"1", "0.5"}
    assert not any(
        c["command"] == "Force_Contact"
        for c in Text(motionview.emit(model, set_contact=True)).values["commands"]["tmplt_run"]
    )


def test_set_contact_writes_the_numbers_in_the_documented_order():
    overrides = ("contacts.6.friction=0", 'contacts.0.smoothing="2 mm/s"')
    model = model_of("transport_4x4.yaml", SMALL, *overrides)
    contacts = Text(motionview.emit(model, set_contact=True)).values["contacts"]
    assert len(contacts) == len(model.pairs)
    numbers = ("penalty", "restitution", "mu_static", "mu_dynamic", "stiction_velocity", "friction_velocity")

    def found(name):
        return [contacts[name][number] for number in numbers if number in contacts[name]]

    assert found("con_note_0_0_support") == [100.0, 0.5]
    assert found("con_motor_1_left_counter_1_left") == [30.5, 0.5, 1.0, 1.0, 2.0, 2.0]


def test_banner_stands_before_the_block_and_holds_no_statement():
    text = motionview.emit(model_of("transport_4x4.yaml", SMALL))
    head, _, block = text.partition("*BeginMDL")
    lines = head.splitlines()
    assert lines[0] == "/" * 70 and "*" not in head and "//" not in block
    assert all("//" not in line for line in lines if line != "/" * 70)
    assert "share width" in head and "Companion script" not in head and "by keyword" in head


def test_numbers_that_follow_parameters_are_those_of_the_model_as_it_is():
    model = model_of("transport_nips.yaml", SMALL)
    script = motionview.companion(model) or ""
    written = _run_script(script)
    turned = _run_script(script, {"ds_contact_2.real_k": 250.0})
    name = next(k for k in written if "note" in k and "motor_1_left" in k)
    assert written[name]["penalty"] == 300.0  # the model does not give it
    assert turned[name] == {**written[name], "penalty": 250.0}
    assert all(turned[k] == written[k] for k in written if "motor_1_left" not in k)
    # a scene without parameters has numbers alone
    assert "def now" not in (motionview.companion(model_of("transport_4x4.yaml", SMALL)) or "def now")
