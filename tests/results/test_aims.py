"""The speed that rules order a drive to have, against orders followed one within the other."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mdlgen.results.aims import aimed


def ordered(orders: list[tuple[float, float, float]]) -> Any:
    """A result in which rules ordered so: time [ms], speed [rad/ms], ramp [ms] of each."""
    rules = [
        SimpleNamespace(orders=(SimpleNamespace(kind="speed", name="r", value=v, ramp=ramp),))
        for _, v, ramp in orders
    ]
    rows = [{"kind": "rule", "rule": k, "time_ms": t} for k, (t, _, _) in enumerate(orders)]
    return SimpleNamespace(model=SimpleNamespace(reactions=SimpleNamespace(rules=rules)), reactions=rows)


def law(moments: Any) -> np.ndarray:
    """A drive that ramps up within 10 ms."""
    return np.asarray(np.interp(moments, [0.0, 10.0], [0.0, 0.2]))


ROLLER: Any = SimpleNamespace(name="r", prescribed=law)


def nested(orders: list[tuple[float, float, float]], moments: np.ndarray) -> np.ndarray:
    """By definition: the law before an order, and from its time on a ramp from where that law is."""
    if not orders:
        return law(moments)
    *before, (begin, target, ramp) = orders
    now = float(nested(before, np.array([begin]))[0])
    share = np.clip((moments - begin) / ramp, 0.0, 1.0) if ramp > 0.0 else 1.0
    return np.where(moments >= begin, now + share * (target - now), nested(before, moments))


@pytest.mark.parametrize("seed", range(20))
def test_orders_follow_one_another(seed: int) -> None:
    """Ramps that another order cuts off, jumps, orders at one time and while the drive ramps up."""
    rng = np.random.default_rng(seed)
    begins = np.sort(rng.choice(rng.uniform(0.0, 40.0, 6), 8))
    ramps = rng.uniform(0.0, 15.0, 8) * rng.integers(0, 2, 8)
    orders = [(float(b), float(rng.normal()), float(r)) for b, r in zip(begins, ramps, strict=True)]
    moments = np.sort(np.append(rng.uniform(0.0, 60.0, 50), begins))
    assert np.array_equal(aimed(ordered(orders), ROLLER, moments), nested(orders, moments))


def test_many_orders_end() -> None:
    """The work doubled with each order, so 200 of them never ended."""
    orders = [(float(k), 0.1 * (k % 2), 0.5) for k in range(200)]
    found = aimed(ordered(orders), ROLLER, np.linspace(0.0, 300.0, 1000))
    assert found[-1] == pytest.approx(0.1)
