"""MDL texts read back: of a few statements, without errors."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader import read


def model(*statements: str) -> str:
    return "\n".join(('*BeginMDL( m, "m" )', *statements, "*StandardInclude(FILE)", "*EndMDL()", ""))


def read_clean(*statements: str) -> dict[str, Any]:
    """Values of a text without errors."""
    reading = read(model(*statements), "t.mdl")
    found, report = reading.values, reading.report
    assert not report.errors, [str(f) for f in report.errors]
    return found


PAIR = (
    '*PointPair( p_hub, "Hub" )',
    '*PointPair( p_end, "End" )',
    '*PointPair( p_up, "Up" )',
    "*SetPoint( p_hub, LEFT, 100, -50, 10 )",
    "*SetPoint( p_end, LEFT, p_hub.l.x+30, p_hub.l.y-40, p_hub.l.z )",
    "*SetPoint( p_up.l, 100, -50, 90 )",
    '*BodyPair( b_arm, "Arm", p_hub, , , ,  )',
    '*BodyPair( b_rod, "Rod", p_end, , , ,  )',
    "*SetBodyInertia( b_arm, LEFT, 2, 10, 20, 25, 1, 2, 3 )",
    "*SetBodyInertia( b_rod, LEFT, 1, 1, 1, 1 )",
)
