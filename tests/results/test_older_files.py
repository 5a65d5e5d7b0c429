"""Files that an older version wrote are read as they were."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
from synthetic import moving

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.runs.provenance import digest
from mdlgen.spec.load import load

TABLES = {"RollerPart": "rollers", "PlanePart": "planes", "GuidePart": "guides", "MeshPart": "meshes"}


def test_a_model_with_a_table_for_each_kind_of_part(tmp_path: Path) -> None:
    result = moving(lower(load(samples() / "retard_pad.yaml")))
    result.save(tmp_path)
    with h5py.File(tmp_path / "result.h5", "r+") as file:
        values = json.loads(bytes(file["model/tables"][()]))
        model = values["map"]["model"]["of"]
        tables = {name: [] for name in TABLES.values()}
        for part in model.pop("machine"):
            tables[TABLES[part["table"]]].append(part)
        del file["model/tables"]
        file["model/tables"] = np.bytes_(json.dumps(values | {"map": values["map"] | {"model": {
            "table": "Model", "of": model | tables}}}).encode())  # fmt: skip
    read = mdlgen.Result.load(tmp_path).model
    assert [part.name for part in read.planes] == ["pad", "table"]
    assert digest(read) == digest(result.model)


def test_contacts_that_know_of_no_air_and_do_not_stick(tmp_path: Path) -> None:
    result = moving(lower(load(samples() / "stack.yaml")))
    result.save(tmp_path)
    with h5py.File(tmp_path / "result.h5", "r+") as file:
        values = json.loads(bytes(file["model/tables"][()]))
        contacts = values["map"]["model"]["of"]["contacts"]["of"]
        for name in ("air_viscosity", "air_roughness", "sticking"):
            del file[contacts.pop(name)["array"]]
        del file["model/tables"]
        file["model/tables"] = np.bytes_(json.dumps(values).encode())
    read = mdlgen.Result.load(tmp_path).model
    assert read.contacts.air_viscosity.tolist() == read.contacts.sticking.tolist() == [0.0] * 5
    assert digest(read) == digest(result.model)
