"""What is asked of a sweep: values that differ, expressions, measures."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sweeps import FOUR, FRICTION, INCLINE, SHORT, wanted

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.results.summary import summary
from mdlgen.study import sweep
from mdlgen.study.design import expression, measure
from mdlgen.study.design.variable import grid, quantity, value_text, variable
from mdlgen.study.execution import perform


class TestVariables:
    @pytest.mark.parametrize(
        ("text", "texts"),
        [
            ("a.b=0.1:0.5:9", ["0.1", "0.15", "0.2", "0.25", "0.3", "0.35", "0.4", "0.45", "0.5"]),
            ("a=180 rad/s:200 rad/s:3", ["180.0 rad/s", "190.0 rad/s", "200.0 rad/s"]),
            ("a=1 mm:0.2 cm:3", ["1.0 mm", "1.5 mm", "2.0 mm"]),
            ("a=5:20:4", ["5", "10", "15", "20"]),
            ("a=5:6:3", ["5.0", "5.5", "6.0"]),
            ("a=-1e-3:1e-3:2", ["-0.001", "0.001"]),
            ("a=[0.1 mm, null, [1, 2], {b: x}, true, '5', 5]",
             ["0.1 mm", "null", "[1, 2]", '{"b": "x"}', "true", '"5"', "5"]),
        ],
    )  # fmt: skip
    def test_ranges_and_lists(self, text: str, texts: list[str]) -> None:
        assert list(variable(text).texts) == texts

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("a.b", "no path and values"),
            ("a b=1:2:3", "no path and values"),
            ("a=1:2", "neither a range nor a list"),
            ("a=1:2 mm:3", "write it at both"),
            ("a=1 s:2 mm:3", "not units of the same thing"),
            ("a=1 furlong:2 furlong:3", "is not a number"),
            ("a=1:2:1", "allowed are 2 to 100000"),
            ("a=1:2:1e3", "no count"),
            ("a=[1, 1]", "stands twice"),
            ("a=[1, 2", "not YAML"),
            ("a=[]", "not a list of values"),
            ("a=[*x]", "anchors and aliases"),
        ],
    )
    def test_what_is_neither_is_refused_in_a_line(self, text: str, message: str) -> None:
        with pytest.raises(SpecError, match=message) as error:
            variable(text)
        assert "--over" in str(error.value) and "\n" not in str(error.value)

    @given(st.text(st.characters(exclude_categories=("C", "Z"), include_characters=" "), max_size=20))
    def test_a_text_of_a_list_reads_back(self, text: str) -> None:
        from mdlgen.spec.load import parse

        assert parse(value_text(text), "value").data == text

    def test_a_grid_is_every_combination_in_order(self) -> None:
        cases = grid([variable("a=1:2:2"), variable("b,c=[x, y]")])
        assert [case.index for case in cases] == [0, 1, 2, 3]
        assert cases[1].overrides == ("a=1", "b=y", "c=y")
        assert [case.values[0][1] for case in cases] == ["1", "1", "2", "2"]
        with pytest.raises(SpecError, match="given twice"):
            grid([variable("a=1:2:2"), variable("b,a=1:2:2")])
        with pytest.raises(SpecError, match="1000000 cases; allowed are 100000"):
            grid([variable("a=1:2:1000"), variable("b=1:2:1000")])

    def test_quantities(self) -> None:
        assert quantity("180 rad/s") == (180.0, "rad/s")
        assert quantity("-.5e3") == (-500.0, "")
        assert quantity("12 monkeys") is None and quantity("[1, 2]") is None

    @pytest.mark.parametrize("kind", ["lhs", "sobol"])
    def test_a_sample_is_the_same_for_the_same_seed(self, kind: str) -> None:
        texts = [f"{FRICTION}=normal(0.3, 0.05, 0.1:0.5)", "run.duration=1 ms:3 ms"]
        cases, how = sweep.over(texts, (kind, 16), 7)
        assert cases == sweep.over(texts, (kind, 16), 7)[0] and how == f"{kind} 16, seed 7"
        assert cases != sweep.over(texts, (kind, 16), 8)[0]
        assert all(0.1 <= float(case.values[0][1]) <= 0.5 for case in cases)
        assert all(case.values[1][1].endswith(" ms") for case in cases)


NAMES = {"a": 2.0, "b.c": -3.0, "rollers.in.force": 4.0, "v": (3.0, 4.0, 0.0), "v.x": 3.0, "none": None}


class TestExpressions:
    @pytest.mark.parametrize(
        ("text", "value"),
        [
            ("1 - a/8", 0.75),
            ("abs(b.c) ** 2 - sqrt(rollers.in.force)", 7.0),
            ("min(a, b.c, 7) + max(a, b.c) - -1", 0.0),
            ("norm(v) - v.x", 2.0),
            ("a < 3 and not b.c > 0", 1.0),
            ("a > 3 or b.c == -3", 1.0),
            ("1 < a < 2", 0.0),
            ("a != 2", 0.0),
            ("none", None),
            ("none > 1 or a > 1", None),
            ("1.e1 + .5", 10.5),
        ],
    )
    def test_what_they_come_to(self, text: str, value: float | None) -> None:
        assert expression.read(text, "--measure").value(NAMES.get) == value

    @pytest.mark.parametrize(
        ("text", "message"),
        [("1/(a - 2)", "division by zero"), ("sqrt(b.c)", "sqrt"), ("b.c**0.5", "no finite number"),
         ("(9**9**9) * a", "large|no finite|range"), ("v + 1", "is a vector"), ("norm(a)", "takes a vector")],
    )  # fmt: skip
    def test_what_has_no_number_says_why(self, text: str, message: str) -> None:
        with pytest.raises(ValueError, match=message):
            expression.read(text, "--measure").value(NAMES.get)

    @pytest.mark.parametrize(
        "text",
        ["__import__('os').system('true')", "a.b.c()", "(lambda: a)()", "a[0]", "[a for a in b]", "f'{a}'",
         "a if b else c", "x := 1", "abs", "abs(a, key=b)", "min(a)", "abs(*a)", "sqrt(1, 2)", "'text'", "1j",
         "1e999", "a // 2", "a % 2", "a @ b", "a << 2", "~a", "a is b", "a in b", "await a", "{a}", "(a,)",
         "(" * 300 + "a" + ")" * 300, "-" * 900 + "a", "a;b", "a\nb", "norm(v - v)", "True", "a" * 1001, ""],
    )  # fmt: skip
    def test_what_is_more_than_arithmetic_is_refused_or_a_name(self, text: str) -> None:
        try:
            found = expression.read(text, "--measure")
        except SpecError as error:
            assert "--measure" in str(error) and len(str(error)) < 400
        else:  # a name, which no run has
            assert text in ("True", "abs") and found.names == (text,)

    @given(st.text(alphabet="ab.()+-*/<>=!,1e_ andortmisxqu", max_size=40))
    def test_any_text_is_an_expression_or_a_line(self, text: str) -> None:
        try:
            found = expression.read(text, "--measure")
        except SpecError:
            return
        try:
            value = found.value(lambda name: 1.5)
        except ValueError:
            return
        assert value is None or isinstance(value, float)


@pytest.fixture(scope="module")
def names() -> dict[str, measure.Value]:
    return measure.known(mdlgen.lower(mdlgen.load(FOUR, ["sheets.note.boxes=[3,4]"])))


class TestMeasures:
    def test_the_names_are_those_of_a_run(self) -> None:
        """A name that is offered before the run must be there after it, and the other way round."""
        model = mdlgen.lower(mdlgen.load(INCLINE, SHORT))
        ran = measure.flat(summary(mdlgen.solve(model)))
        offered = measure.known(model)
        assert set(ran) <= set(offered)
        assert {name for name in offered if not name.startswith("events.")} <= set(ran)
        assert {n for n, v in ran.items() if isinstance(v, tuple)} == {
            n for n, v in offered.items() if isinstance(v, tuple)
        }

    def test_names_and_expressions(self, names: dict[str, measure.Value]) -> None:
        found = measure.measures(
            ["sheets.note.yaw_deg", "slip=1 - sheets.note.travel_mm.x/93", "v=sheets.note.speed_mm_per_s",
             "events.jam.motor_1_left", "sheets.note.strain.max_md", "energy.balance_error"],
            names, "--measure",
        )  # fmt: skip
        assert [name for name, _ in found] == [
            "sheets.note.yaw_deg", "slip", "v.x", "v.y", "v.z", "events.jam.motor_1_left",
            "sheets.note.strain.max_md", "energy.balance_error",
        ]  # fmt: skip
        assert dict(found)["v.y"] == "sheets.note.speed_mm_per_s.y"

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("sheets.note.yaw_degg", "did you mean 'sheets.note.yaw_deg'?"),
            ("slip=1 - sheets.note.travl_mm.x", "did you mean 'sheets.note.travel_mm.x'?"),
            ("zzz", "it has mark, duration_ms, t_end_ms, steps"),
            ("1 - sheets.note.travel_mm", "is a vector; write sheets.note.travel_mm.x"),
            ("wall_s", "times.csv has it"),
            ("solver", "there is no number 'solver'"),
            ("status=steps", "stands twice"),
        ],
    )
    def test_what_is_not_there_is_reported_with_what_is(
        self, names: dict[str, measure.Value], text: str, message: str
    ) -> None:
        with pytest.raises(SpecError) as error:
            measure.measures([text], names, "--measure")
        assert message in str(error.value)

    def test_events_are_counted(self) -> None:
        events = [
            {"kind": "double_feed", "sheet": "a", "other": "b", "roller": "r"},
            {"kind": "double_feed", "sheet": "a", "other": "c", "roller": "r"},
        ]
        found = measure.flat({"events": events})
        assert found["events.double_feed"] == 2.0 and found["events.jam"] == 0.0
        assert found["events.double_feed.b"] == 1.0 and found["events.double_feed.a"] == 2.0

    def test_only_what_is_asked_for_is_worked_out(self, monkeypatch: pytest.MonkeyPatch) -> None:
        asked = wanted(f"{FRICTION}=0.1:0.2:2")

        def never(*_: object) -> None:
            raise AssertionError("worked out for nothing")

        monkeypatch.setattr("mdlgen.results.events.events", never)
        monkeypatch.setattr("mdlgen.results.strain.strains", never)
        assert perform.perform(asked.task, asked.cases[0]).ok
        events = replace(asked.task, measures=(("jams", "events.jam"),))
        assert "worked out for nothing" in perform.perform(events, asked.cases[0]).status


def test_margins_of_requirements_are_measures() -> None:
    """In the order of the scene; of an event less how often it came."""
    rows = [
        {"requirement": "yaw within 1 deg", "passed": True, "value": 0.2, "unit": "deg", "margin": 0.8},
        {"requirement": "no jam", "passed": False, "value": 2.0, "unit": "", "margin": None},
        {"requirement": "strain below 1 %", "passed": False, "value": None, "unit": "%", "margin": None},
    ]
    found = measure.flat({"verdict": {"passed": False, "requirements": rows, "events": ["jam"]}})
    margins = {f"verdict.margin_{k}": value for k, value in enumerate([0.8, -2.0, None], 1)}
    assert found == {"verdict.passed": 0.0, **margins}
    asked = 'require=["sheets.block.travel below 1 m", "no jam"]'
    own = wanted(f"{FRICTION}=[0.1]", measures=["verdict.margin_1", "verdict.margin_2"], sets=[*SHORT, asked])
    row = perform.perform(own.task, own.cases[0])
    assert row.measures["verdict.margin_1"] == pytest.approx(1.0, rel=1e-4)  # m, as it is given
    assert row.measures["verdict.margin_2"] == 0.0
