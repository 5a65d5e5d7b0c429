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


# Mappings in which keys of these names stand side by side: of a motion, its direction and its profile.
_BESIDE = frozenset(("pivot", "slide"))


def others(key: object, within: object = None) -> set[str]:
    """The keys that one takes the place of, in the mapping that is called `within`."""
    if within in _BESIDE:
        return set()
    return {other for group in _ALTERNATIVES if key in group for other in group - {key}}
