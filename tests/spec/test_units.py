"""Quantities: what is written reads back, and a wrong unit never passes."""

from __future__ import annotations

import contextlib
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mdlgen.units import exact_quantity, parse_quantity, parse_unit

UNITS = ("mm", "g", "ms", "rad", "N", "MPa", "N/mm", "N*mm/rad", "m/s^2", "N/mm^1.5", "rad/s", "kg", "deg")
FINITE = st.floats(min_value=-1e100, max_value=1e100, allow_nan=False)


@given(FINITE, st.sampled_from(UNITS))
def test_round_trip(value: float, unit: str) -> None:
    # one division and one product: an ulp each, and another where the quotient is subnormal
    assert parse_quantity(exact_quantity(value, unit), unit) == pytest.approx(value, rel=4e-16, abs=1e-300)


@given(FINITE, st.sampled_from(UNITS), st.sampled_from(UNITS))
def test_wrong_dimension_is_refused(value: float, unit: str, expected: str) -> None:
    text = f"{value!r} {unit}"
    if parse_unit(unit).dimension == parse_unit(expected).dimension:
        parse_quantity(text, expected)
        return
    with pytest.raises(ValueError, match="wrong unit") as raised:
        parse_quantity(text, expected)
    assert expected in str(raised.value)


@given(st.one_of(FINITE, st.integers(), st.booleans(), st.none(), st.lists(st.integers())))
def test_what_is_no_text_is_refused(value: object) -> None:
    with pytest.raises(ValueError, match="expected"):
        parse_quantity(value, "mm")


@given(st.text(max_size=40))
def test_any_text_is_a_finite_number_or_a_value_error(text: str) -> None:
    with contextlib.suppress(ValueError):
        assert math.isfinite(parse_quantity(text, "mm"))


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("1 N", "N", 1.0),  # g mm/ms^2
        ("9.81 m/s^2", "mm/ms^2", 9.81e-3),
        ("1 MPa", "N/mm^2", 1.0),
        ("0.72g", "kg", 0.72),
        ("186.7 rad/s", "rad/ms", 0.1867),
        ("60 rpm", "rad/s", 2 * math.pi / 1000),
        ("180 deg", "rad", math.pi),
        ("300 N/mm^1.5", "N/mm^1.5", 300.0),
        (" 1e3 um ", "mm", 1.0),
        ("3 N/mm2", "MPa", 3.0),
        ("3 N/mm²", "MPa", 3.0),
        ("300 N/mm1.5", "N/mm^1.5", 300.0),
    ],
)
def test_known_values(text: str, unit: str, value: float) -> None:
    assert parse_quantity(text, unit) == pytest.approx(value, rel=1e-15)  # a product of table factors


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("0,1 mm", "write 0.1 mm"),
        ("-7,5016 mm", "write -7.5016 mm"),
        ("1,400 mm", "write 1.400 mm or 1400 mm"),
        ("1,400.5 mm", "write 1400.5 mm"),
        ("1,2,3 mm", "decimals are written with a point, as 0.5"),
    ],
)
def test_a_decimal_comma_is_answered(text: str, meant: str) -> None:
    with pytest.raises(ValueError, match="has a comma") as raised:
        parse_quantity(text, "mm")
    assert str(raised.value) == f"{text!r} has a comma; {meant}"


@pytest.mark.parametrize(
    "text", ["1e400 mm", "1 mm^99", "1 furlong", "1", "", "mm", "nan mm", "inf mm", "1 mm mm"]
)
def test_nonsense_is_refused(text: str) -> None:
    with pytest.raises(ValueError):
        parse_quantity(text, "mm")


@pytest.mark.parametrize("unit", ["rad/s", "mm/s", "m/s^2", "deg", "Hz", "N*mm/rad", "kg", "um", "N/mm^1.5"])
def test_any_value_has_a_text_that_is_exactly_it(unit: str) -> None:
    """No number of rad/s is 0.09333333333333334 rad/ms to the last bit."""
    generator = np.random.default_rng(1)
    values = [
        0.09333333333333334,
        *generator.uniform(-3.0, 3.0, 500),
        *np.exp(generator.uniform(-40.0, 40.0, 500)),
    ]
    texts = [exact_quantity(float(value), unit) for value in values]
    assert [parse_quantity(text, unit) for text in texts] == values
    assert exact_quantity(0.09333333333333334, "rad/s") == "0.09333333333333334 rad/ms"
