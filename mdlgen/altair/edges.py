"""The note in an MDL file about the edges of plates."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import ON_PLATES, Model


def edge_note(model: Model) -> tuple[str, ...]:
    """The note in an MDL file about the edges of the plates that sheets touch."""
    if not np.isin(model.contacts.kind, ON_PLATES).any():
        return ()
    return (
        "  Planes and guides are boxes with sharp edges here, where MotionSolve finds normals of its own. In",
        "  the local run of mdlgen their edges have a radius, and a sheet below a face stubs on its end.",
    )
