"""Contacts that no law is there for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import mdlgen
from mdlgen.errors import RefusedError
from mdlgen.mechanics.solved import WITH_LAW
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import load


@pytest.mark.parametrize("name", ["lattice", "exudyn"])
def test_a_contact_of_a_kind_without_a_law_is_refused_by_name(name: str) -> None:
    model = lower(load(samples() / "verify" / "incline.yaml"))
    table = model.contacts
    odd = replace(table, kind=np.full(len(table), max(WITH_LAW) + 1))
    with pytest.raises(RefusedError, match=f"no law yet for the contact of {table.part_a[0]}"):
        mdlgen.solve(replace(model, contacts=odd), name)
