"""What is drawn, and what is made of it: distributions, samples, intervals, effects, links."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from mdlgen.errors import SpecError
from mdlgen.paths import samples
from mdlgen.study.analysis.effects import interaction, main_effect, sobol
from mdlgen.study.analysis.findings import findings, findings_text
from mdlgen.study.analysis.probability import caveat, probability
from mdlgen.study.analysis.table import columns
from mdlgen.study.design.distribution import Choice, Distribution, parse_distribution
from mdlgen.study.design.link import check_links, parse_link
from mdlgen.study.design.sampling import sample
from mdlgen.study.design.task import Task, task
from mdlgen.study.execution.row import FAILED, OK, CaseRow
from mdlgen.study.sweep import over, sweep

INCLINE = samples() / "verify" / "incline.yaml"
MIDDLE = np.linspace(0.001, 0.999, 999)


def drawn(text: str) -> Distribution:
    found = parse_distribution(text)
    assert isinstance(found, Distribution)
    return found


class TestDistributions:
    @pytest.mark.parametrize(
        ("text", "unit", "probability_of"),
        [
            ("a=0.1:0.5", "", lambda x: (x - 0.1) / 0.4),
            ("a=uniform(1 mm, 3000 um)", "mm", lambda x: (x - 1.0) / 2.0),
            ("a.b=normal(0.3, 0.05)", "", lambda x: stats.norm.cdf(x, 0.3, 0.05)),
            ("a=normal(2 m/s, 100 mm/s)", "m/s", lambda x: stats.norm.cdf(x, 2.0, 0.1)),
            ("a=lognormal(0.3 N, 0.2)", "N", lambda x: stats.norm.cdf(np.log(x / 0.3), 0.0, 0.2)),
        ],
    )
    def test_values_have_the_probabilities_that_they_should(self, text, unit, probability_of) -> None:
        found = drawn(text)
        assert found.unit == unit
        # ten digits of a value are kept
        assert probability_of(found.quantile(MIDDLE)) == pytest.approx(MIDDLE, abs=2e-8)

    @pytest.mark.parametrize(
        ("text", "whole"),
        [
            ("a=normal(0.3, 0.05, 0.28:0.5)", lambda x: stats.norm.cdf(x, 0.3, 0.05)),
            ("a=normal(0.3, 0.05, 0.45:0.5)", lambda x: stats.norm.cdf(x, 0.3, 0.05)),
            ("a=lognormal(0.3, 0.2, 0.28:0.5)", lambda x: stats.norm.cdf(np.log(x / 0.3), 0.0, 0.2)),
        ],
    )
    def test_limits_cut_the_density_off_and_scale_up_the_rest(self, text, whole) -> None:
        found = drawn(text)
        values = found.quantile(MIDDLE)
        low, high = whole(found.low), whole(found.high)
        assert (whole(values) - low) / (high - low) == pytest.approx(MIDDLE, abs=1e-6)
        ends = found.quantile(np.array([0.0, 1.0]))
        assert found.low <= ends[0] < ends[1] <= found.high

    def test_a_list_is_a_choice_of_texts(self) -> None:
        found = parse_distribution("a=[5 g, 10 g, [1, 2]]")
        assert isinstance(found, Choice)
        assert [found.text(v) for v in found.quantile(np.array([0.0, 0.4, 0.99, 1.0]))] == [
            "5 g",
            "10 g",
            "[1, 2]",
            "[1, 2]",
        ]

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("a", "no path and values"),
            ("a=1", "is no range"),
            ("a=1:2:3", "is no range"),
            ("a=2:1", "must be below"),
            ("a=1 mm:2", "write it at both"),
            ("a=1 mm:2 g", "not units of the same thing"),
            ("a=norml(1, 2)", "did you mean 'normal'?"),
            ("a=normal(1)", "has 1 values; write normal(0.3, 0.05)"),
            ("a=normal(1, 0)", "deviation must be above 0"),
            ("a=normal(1, 1, 2:1)", "must be below the upper limit"),
            ("a=normal(0, 1, 9:10)", "leave a tail alone"),
            ("a=normal(1, 1, 2)", "is no range"),
            ("a=lognormal(-1, 1)", "median must be above 0"),
            ("a=lognormal(1 mm, 1 mm)", "has no unit"),
        ],
    )
    def test_what_is_none_is_reported_in_one_line(self, text: str, message: str) -> None:
        with pytest.raises(SpecError) as error:
            parse_distribution(text)
        assert message in str(error.value) and "\n" not in str(error.value)


class TestSamples:
    TWO = (drawn("a=0:1"), drawn("b=normal(10, 2)"))

    @pytest.mark.parametrize(
        ("kind", "first"),
        [
            # written down from one machine: another one must draw the same
            ("random", [[0.5118216247, 13.29873267], [0.1441596127, 13.26379476]]),
            ("lhs", [[0.3252413631, 11.08588974], [0.588720367, 8.091269567]]),
            ("sobol", [[0.286169162, 8.032630776], [0.5817833487, 13.07581186]]),
            ("saltelli", [[0.286169162, 8.032630776], [0.7498305487, 11.75465305]]),
        ],
    )
    def test_a_seed_gives_the_same_cases_everywhere(self, kind: str, first: list) -> None:
        found = sample(kind, 4, self.TWO, 1)
        assert (found == sample(kind, 4, self.TWO, 1)).all()
        assert (found != sample(kind, 4, self.TWO, 2)).any()
        assert found[:2].tolist() == first

    def test_a_latin_hypercube_has_one_case_in_each_layer(self) -> None:
        found = sample("lhs", 50, self.TWO, 3)
        layers = np.floor(50 * np.stack([found[:, 0], stats.norm.cdf(found[:, 1], 10, 2)], axis=1))
        assert all(sorted(column) == list(range(50)) for column in layers.T)

    def test_a_sobol_sequence_finds_a_mean_better_than_chance(self) -> None:
        def miss(kind: str) -> float:
            found = [sample(kind, 256, self.TWO, seed) for seed in range(20)]
            # the mean of x0^2 x1 is 10/3
            return float(np.mean([abs((x[:, 0] ** 2 * x[:, 1]).mean() - 10.0 / 3.0) for x in found]))

        assert miss("sobol") < 0.1 * miss("random")

    def test_saltelli_changes_one_variable_at_a_time(self) -> None:
        one, other, *mixed = sample("saltelli", 8, self.TWO, 1).reshape(4, 8, 2)
        assert (one != other).all()
        for k, rows in enumerate(mixed):
            assert (rows[:, k] == other[:, k]).all() and (rows[:, 1 - k] == one[:, 1 - k]).all()

    @pytest.mark.parametrize(
        ("kind", "count", "seed", "message"),
        [("lsh", 4, 1, "did you mean 'lhs'?"), ("lhs", 0, 1, "at least"), ("lhs", 4, -1, "at least")],
    )
    def test_what_cannot_be_drawn_is_reported(self, kind: str, count: int, seed: int, message: str) -> None:
        with pytest.raises(SpecError, match=message.replace("?", r"\?")):
            sample(kind, count, self.TWO, seed)


class TestProbability:
    def test_ends_are_those_of_the_closed_forms(self) -> None:
        none, all_of = probability(0, 20), probability(20, 20)
        # nothing in n cases: (1 - p)^n = 2.5 %
        assert (none.low, none.high) == (0.0, pytest.approx(1.0 - 0.025 ** (1 / 20), rel=1e-12))
        assert (all_of.low, all_of.high) == (pytest.approx(0.025 ** (1 / 20), rel=1e-12), 1.0)
        some = probability(3, 40)
        assert stats.binom.sf(2, 40, some.low) == pytest.approx(0.025, rel=1e-9)
        assert stats.binom.cdf(3, 40, some.high) == pytest.approx(0.025, rel=1e-9)

    @pytest.mark.parametrize("true", [0.01, 0.05, 0.3, 0.5])
    @pytest.mark.parametrize("cases", [20, 200])
    def test_the_interval_holds_the_probability_as_often_as_it_says(self, true: float, cases: int) -> None:
        """Summed over everything that can come out, so there is no chance in it."""
        found = [probability(hits, cases) for hits in range(cases + 1)]
        held = [stats.binom.pmf(p.hits, cases, true) for p in found if p.low <= true <= p.high]
        assert sum(held) >= 0.95

    def test_failed_cases_widen_it_both_ways(self) -> None:
        found = probability(5, 90, failed=10)
        assert found.value == 5 / 90
        assert found.low == probability(5, 100).low and found.high == probability(15, 100).high
        assert math.isnan(probability(0, 0, failed=3).value)
        assert (probability(0, 0, failed=3).low, probability(0, 0, failed=3).high) == (0.0, 1.0)

    def test_what_a_sample_does_to_it_is_said(self) -> None:
        assert caveat("random") == ""
        assert "spread evenly" in caveat("lhs") and "not a probability" in caveat("grid")


def ishigami(x: np.ndarray) -> np.ndarray:
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


class TestEffects:
    THREE = tuple(drawn(f"{name}={-math.pi}:{math.pi}") for name in "abc")

    def test_sobol_indices_are_those_of_the_closed_form(self) -> None:
        x = sample("saltelli", 1024, self.THREE, 3)
        found = sobol(ishigami(x).tolist(), 3)
        assert found is not None
        # Ishigami and Homma, 1990, with a = 7, b = 0.1
        for indices, first, total in zip(found, (0.3139, 0.4424, 0.0), (0.5576, 0.4424, 0.2437), strict=True):
            assert indices.first.low <= first <= indices.first.high
            assert indices.total.low <= total <= indices.total.high
            assert indices.first.value == pytest.approx(first, abs=0.02)

    def test_they_are_those_of_scipy(self) -> None:
        y = ishigami(sample("saltelli", 64, self.THREE, 1))
        rows = y.reshape(5, 1, 64)
        theirs = stats.sobol_indices(func={"f_A": rows[0], "f_B": rows[1], "f_AB": rows[2:]}, n=64)
        found = sobol(y.tolist(), 3)
        assert found is not None
        assert [i.first.value for i in found] == pytest.approx(theirs.first_order.ravel().tolist(), rel=1e-9)
        assert [i.total.value for i in found] == pytest.approx(theirs.total_order.ravel().tolist(), rel=1e-9)

    def test_a_missing_number_takes_its_row_out(self) -> None:
        y = ishigami(sample("saltelli", 64, self.THREE, 1)).reshape(5, 64)
        holed = y.copy()
        holed[3, 7] = np.nan
        assert sobol(holed.ravel().tolist(), 3) == sobol(np.delete(y, 7, axis=1).ravel().tolist(), 3)
        assert sobol([1.0] * 20, 3) is None
        with pytest.raises(SpecError, match="no sample saltelli"):
            sobol([1.0] * 21, 3)

    def test_main_effects_share_the_variance_of_a_sum(self) -> None:
        a, b = (v.ravel() for v in np.meshgrid(np.arange(10.0), np.arange(10.0)))
        one, other = (
            main_effect(a.tolist(), (a + 2 * b).tolist()),
            main_effect(b.tolist(), (a + 2 * b).tolist()),
        )
        assert one is not None and other is not None
        # 1 : 4, less what chance alone gives to ten groups of ten
        assert (one.share, other.share) == (pytest.approx(0.12, abs=1e-9), pytest.approx(0.78, abs=1e-9))
        assert (one.range, other.range) == (9.0, 18.0)
        assert [group.mean for group in one.groups] == [k + 9.0 for k in range(10)]
        assert main_effect(a.tolist(), [1.0] * 100) is None

    def test_what_two_do_together_is_what_a_sum_leaves(self) -> None:
        """y = a + b + 3 a b with a and b -1 or 1 or between: variances 1, 1 and 9 times that of a grid."""
        values = np.linspace(-1.0, 1.0, 9)
        a, b = (v.ravel() for v in np.meshgrid(values, values))
        square = float((values**2).mean())
        share = 9.0 * square**2 / (2.0 * square + 9.0 * square**2)
        assert interaction(a.tolist(), b.tolist(), (a + b + 3 * a * b).tolist()) == pytest.approx(share)
        assert interaction(a.tolist(), b.tolist(), (a + b).tolist()) == pytest.approx(0.0, abs=1e-12)
        # a third variable is no interaction of these two; nor is what chance gives
        x = sample("random", 2000, self.THREE, 1)
        one, other = x[:, 0].tolist(), x[:, 1].tolist()
        assert (interaction(one, other, x.sum(axis=1).tolist()) or 0.0) < 0.02
        assert (interaction(one, other, (x[:, 0] * x[:, 1]).tolist()) or 0.0) > 0.05
        # too few cases for so many cells, and a measure of round-off
        assert interaction(one[:20], other[:20], x[:20, 2].tolist()) is None
        assert interaction(a.tolist(), b.tolist(), (1e-17 * a).tolist()) is None
        assert main_effect(a.tolist(), (1e-17 * a).tolist()) is None

    def test_a_variable_without_effect_has_none(self) -> None:
        x = sample("random", 1000, self.THREE, 1)
        found = main_effect(x[:, 2].tolist(), (x[:, 0] + x[:, 1]).tolist())
        assert found is not None and len(found.groups) == 5
        assert found.share < 0.02


class TestLinks:
    @pytest.mark.parametrize(
        ("text", "value", "follows"),
        [
            ("p.q=186 rad/s - delta", "10 rad/s", "176.0 rad/s"),
            ("p=delta", "0.3", "0.3"),
            ("p=-2*delta", "0.1 mm", "-0.2 mm"),
            ("p=10.2 mm-0.5*delta", "100 um", "10.15 mm"),
            ("p=1 + delta", "0.5", "1.5"),
        ],
    )
    def test_a_value_follows(self, text: str, value: str, follows: str) -> None:
        assert parse_link(text).text(value) == follows

    @pytest.mark.parametrize("text", ["p", "p=3", "p=a*b", "p=186 rad/s", "p=__import__('os')", "p=a + b"])
    def test_what_is_no_multiple_of_a_name_is_reported(self, text: str) -> None:
        with pytest.raises(SpecError, match="--let"):
            parse_link(text)

    def test_units_and_names_are_looked_at(self) -> None:
        with pytest.raises(SpecError, match="does not go with the unit"):
            parse_link("p=1 mm + d").text("2")
        with pytest.raises(SpecError, match="did you mean 'delta'"):
            check_links(["p=delt"], ["delta"])
        with pytest.raises(SpecError, match="given twice"):
            check_links(["p=delta", "p=2*delta"], ["delta"])

    def test_a_case_sets_what_follows_and_not_the_name(self) -> None:
        asked = task(INCLINE, ["run.duration=2 ms"], lets=("contacts.0.friction=0.5 - d",))
        cases, _ = over(["d=0.1:0.3:3", "sheets.block.mass=[5 g]"], None, 1)
        assert asked.overrides(cases[1]) == (
            "run.duration=2 ms",
            "sheets.block.mass=5 g",
            "contacts.0.friction=0.3",
        )
        assert asked.scene(cases[1]).contacts[0].friction.static == pytest.approx(0.3)


def test_findings_of_a_sample() -> None:
    """Of rows that are made up: numbers for findings.json, and lines for a terminal."""
    asked = Task("x.yaml", "", ".", measures=(("y", "y"), ("jam", "events.jam > 0")), events=("jam",))
    values = sample("random", 100, TestSamples.TWO, 1)
    rows = [
        CaseRow(k, (("a", repr(float(a))), ("b", repr(float(b)))), OK, "ok", {"y": a, "jam": float(a > 0.9)})
        for k, (a, b) in enumerate(values.tolist())
    ]
    rows[5] = CaseRow(5, rows[5].values, FAILED, "it did not converge")
    record = findings(asked, "random 100, seed 1", rows, columns(rows, ["y", "jam"]))
    hits = int((np.delete(values[:, 0], 5) > 0.9).sum())
    assert (record["events"]["jam"]["hits"], record["events"]["jam"]["known"]) == (hits, 99)
    assert record["effects"]["y"]["a"]["share"] > 0.9 > 0.1 > record["effects"]["y"]["b"]["share"]
    lines = findings_text(record)
    assert lines[0].startswith("probability of jam: 0.") and "1 cases without an answer" in lines[0]
    assert any(line.startswith("y, part of its variance by each value alone: a 9") for line in lines)


class TestSlip:
    """A block on a slope of 20 deg slips where its friction is below tan 20 deg, as 5 % of normal(0.4133,
    0.03) are; with 40 runs here, with 1,000 by the command in README.md."""

    def test_the_probability_of_a_slip_is_found(self) -> None:
        from test_sweep import Here

        threshold = math.tan(math.radians(20.0))
        scatter = f"contacts.0.friction=normal({threshold + 1.6448536 * 0.03:.6f}, 0.03)"
        cases, how = over([scatter], ("random", 40), 5)
        asked = sweep(
            task(INCLINE, ["run.duration=100 ms"]),
            cases,
            how,
            ["sheets.block.travel_mm.x"],
            # faster than friction that is smoothed over 1 mm/s creeps
            ["slips=sheets.block.speed_mm_per_s.x > 1.5"],
        )
        rows = list(Here().rows(asked.task, asked.cases))
        found = findings(asked.task, how, rows, columns(rows, ["sheets.block.travel_mm.x", "slips"]))
        slips = found["events"]["slips"]
        assert slips["known"] == 40 and slips["low"] < 0.05 < slips["high"]
        # and each case by itself, but for those in which 100 ms are too short to tell
        for row in rows:
            friction = float(row.values[0][1])
            if abs(friction - threshold) > 2e-3:
                assert row.measures["slips"] == (friction < threshold)
