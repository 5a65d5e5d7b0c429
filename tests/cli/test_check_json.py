"""`mdlgen check --json` against the paper's Table 2."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mdlgen.cli import app
from mdlgen.paths import samples

# The paper gives two to three digits.
PAPER = {"rel": 0.01}


def derived(capsys: pytest.CaptureFixture[str], *sets: str) -> dict[str, float]:
    return check(capsys, *sets)["sheets"]["note"]["derived"]


def check(capsys: pytest.CaptureFixture[str], *sets: str) -> dict[str, Any]:
    args = ["check", str(samples() / "transport_4x4.yaml"), "--json"]
    for value in sets:
        args += ["--set", value]
    with pytest.raises(SystemExit) as ended:
        app(args, prog_name="mdlgen")
    assert ended.value.code == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize(
    ("layout", "k_x", "k_y", "c_x", "c_y"),
    [("center_to_center", 317, 124, 0.256, 0.160), ("edge_to_edge", 158.5, 62.0, 0.128, 0.080)],
)
def test_translation(
    capsys: pytest.CaptureFixture[str], layout: str, k_x: float, k_y: float, c_x: float, c_y: float
) -> None:
    found = derived(capsys, f"sheets.note.layout={layout}", "sheets.note.grid=paper")
    assert [found[n] for n in ("k_x", "k_y", "c_x", "c_y")] == pytest.approx([k_x, k_y, c_x, c_y], **PAPER)
    assert found["k_z"] == 10 * found["k_x"]
    assert (found["d_x"], found["d_y"]) == pytest.approx((67 / 9, 127 / 19), rel=1e-15)  # Eq. 1


@pytest.mark.parametrize(
    ("layout", "k_t", "c_t"),
    [
        ("center_to_center", (0.27, 0.45, 10), (7.48, 3.22, 45.5)),
        ("edge_to_edge", (0.15, 0.185, 5), (5.58, 2.06, 22.8)),
    ],
)
def test_rotation_as_the_paper_has_it(
    capsys: pytest.CaptureFixture[str], layout: str, k_t: tuple[float, ...], c_t: tuple[float, ...]
) -> None:
    """Table 2's rotational dampings are 1000 times Eq. 7 in mm, N, g, ms."""
    sets = [f"materials.eur10.k_t{a}={k} N*mm/rad" for a, k in zip("xyz", k_t, strict=True)]
    found = derived(
        capsys, *sets, f"sheets.note.layout={layout}", "sheets.note.grid=paper",
        "materials.eur10.damping.rotation=paper",
    )  # fmt: skip
    assert [1000 * found[f"c_t{a}"] for a in "xyz"] == pytest.approx(c_t, **PAPER)


def test_counts_and_pairs(capsys: pytest.CaptureFixture[str]) -> None:
    found = check(capsys)
    note = found["sheets"]["note"]
    # two bushings per joint of a 10 x 20 grid
    assert (note["boxes"], note["bushings"]) == (200, 2 * (9 * 20 + 10 * 19))
    # 200 boxes by 8 rollers and a plane, and 4 pairs of rollers
    assert found["pairs"]["possible"] == 200 * 9 + 4
    assert 0 < found["pairs"]["kept"] < found["pairs"]["possible"]
    assert found["pairs"]["margin_mm"] == 5.0
    assert found["lints"] == []


@pytest.mark.parametrize("layout", ["center_to_center", "edge_to_edge"])
def test_both_forms_of_bending_agree(capsys: pytest.CaptureFixture[str], layout: str) -> None:
    width = [
        "materials.eur10.D_md=0.4 N*mm",
        "materials.eur10.D_cd=0.242 N*mm",
        f"sheets.note.layout={layout}",
    ]
    bending = check(capsys, *width)["sheets"]["note"]["bending"]
    # there and back: a few ulp
    assert (bending["D_md"], bending["D_cd"]) == pytest.approx((0.4, 0.242), rel=1e-14)
