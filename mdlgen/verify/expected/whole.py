"""Expected content of an MDL file for a Model, from its tables and nothing else, in the units of the file.

Names follow the promise of the text: `b_` body, `p_` point, `bsh_` bushing, `gbox_`, `gcyl_`, `gcad_`
graphic, `j_` joint, `mot_` motion, `cs_` spring, `con_` contact, `m_` marker, `o_` output, `ds_` data set.
"""

from __future__ import annotations

from mdlgen.model.tables import (
    Model,
)
from mdlgen.verify.expected.axles import axles
from mdlgen.verify.expected.bodies import bodies, velocities
from mdlgen.verify.expected.bushings import bushings, curve_laws, curves, springs
from mdlgen.verify.expected.clutches import clutches
from mdlgen.verify.expected.graphics import boxes, surfaces
from mdlgen.verify.expected.joints import joints
from mdlgen.verify.expected.loads import loads
from mdlgen.verify.expected.markers import markers, outputs, vectors
from mdlgen.verify.expected.motions import motions
from mdlgen.verify.expected.parts.kinds import own_tables
from mdlgen.verify.expected.points import points
from mdlgen.verify.expected.stops import stops
from mdlgen.verify.expected.times import Times
from mdlgen.verify.tables import Table


def expected(model: Model, times: Times) -> dict[str, Table]:
    """All tables of a Model, by kind; `times` are those at which the laws of drives are evaluated [s]."""
    return {
        "points": points(model),
        "bodies": bodies(model),
        "bushings": bushings(model),
        "curves": curves(model),
        "curve laws": curve_laws(model),
        "springs": springs(model),
        "boxes": boxes(model),
        **own_tables(model),
        "joints": joints(model),
        "motions": motions(model, times),
        "clutches": clutches(model, times),
        "axles": axles(model, times),
        "stops": stops(model, times),
        "velocities": velocities(model),
        "markers": markers(model),
        "vectors": vectors(model),
        "surfaces": surfaces(model),
        "outputs": outputs(model),
        "loads": loads(model, times),
    }
