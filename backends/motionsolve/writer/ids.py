"""Ids of a deck: body k of a Model is Body_Rigid k + 2, behind ground, and has Post_Graphic k + 1."""

from __future__ import annotations

GROUND_ID = 1
GLOBAL_FRAME = 1  # the first marker


def body_id(body: int) -> int:
    """Id of a body of the Model, or of GROUND (-1)."""
    return body + 2


def graphic_id(body: int) -> int:
    """Id of the graphic of a body of the Model."""
    return body + 1
