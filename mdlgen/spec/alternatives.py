"""Keys that stand for one another: where one is set over what was given, the others go."""

from __future__ import annotations

_ALTERNATIVES = (
    {"k_tx", "D_cd"},
    {"k_ty", "D_md"},
    {"E_md", "curve_md"},
    {"E_cd", "curve_cd"},
    {"points", "file"},
    {"turn", "rotation"},
    {"radius", "diameter"},
    {"speed", "profile"},
    {"ramp", "profile"},
    *({old, new} for old in ("speed", "profile") for new in ("surface_speed", "direction")),
    {"at", "edge"},
    {"force", "moment", "stress"},
    {"mass", "density", "grammage"},
    {"time", "loss_factor"},
    {"time", "at"},
    *({old, new} for old in ("ratio", "ratio_ty", "rotation") for new in ("time", "loss_factor", "at")),
)


def others(key: object) -> set[str]:
    """The keys that one takes the place of."""
    return {other for group in _ALTERNATIVES if key in group for other in group - {key}}
