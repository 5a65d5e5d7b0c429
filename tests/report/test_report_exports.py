"""What other programs read of a run: GLB, VTKHDF, and pictures for print."""

from __future__ import annotations

import io
import json
import struct
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from ran import ran, transport
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.errors import SpecError
from mdlgen.model.tables import Model
from mdlgen.report.export.gltf import LASTS, glb
from mdlgen.report.export.vtkhdf import vtkhdf
from mdlgen.report.figures.stills import stills, times
from mdlgen.report.meshes import machine
from mdlgen.report.motion import names, poses
from mdlgen.results.result import Result

# z up to y up, mm to m
TURNED = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]) / 1000.0


@pytest.fixture(scope="module")
def result() -> Result:
    return transport()


def boxes(model: Model) -> int:
    return sum(sheet.count for sheet in model.sheets)


class TestGlb:
    @pytest.mark.parametrize("state", [0, 100, 200])
    def test_trimesh_finds_every_body_where_it_is(self, result: Result, state: int) -> None:
        trimesh = pytest.importorskip("trimesh")
        scene = trimesh.load(io.BytesIO(glb(result, state)), file_type="glb")
        place, turn = poses(result, np.array([state]))
        for body, name in enumerate(result.model.bodies.name):
            matrix, shape = scene.graph.get(name)
            # four-byte numbers, of 0.1 m at most
            assert np.abs(matrix[:3, 3] - TURNED @ place[0, body]).max() < 1e-8
            axes = TURNED @ Rotation.from_quat(np.roll(turn[0, body], -1)).as_matrix()
            half = result.model.bodies.half[body] if body < boxes(result.model) else np.ones(3)
            assert np.abs(matrix[:3, :3] - axes * half).max() < 1e-8
            assert scene.geometry[shape].is_volume

    def test_sizes_are_those_of_the_parts(self, result: Result) -> None:
        trimesh = pytest.importorskip("trimesh")
        scene = trimesh.load(io.BytesIO(glb(result)), file_type="glb")
        for mesh in machine(result.model):
            found = scene.geometry[f"{mesh.name} {mesh.kind}"]
            assert np.abs(found.bounds - [mesh.points.min(axis=0), mesh.points.max(axis=0)]).max() < 1e-5

    def test_key_frames_are_the_stored_states(self, result: Result) -> None:
        data = glb(result)
        assert data == glb(result)
        length, size, kind = struct.unpack_from("<III", data, 8)
        assert (data[:4], length, kind) == (b"glTF", len(data), 0x4E4F534A)
        record, blob = json.loads(data[20 : 20 + size]), data[28 + size :]

        def read(number: int) -> np.ndarray:
            accessor = record["accessors"][number]
            view = record["bufferViews"][accessor["bufferView"]]
            width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
            found = np.frombuffer(blob, "<f4", accessor["count"] * width, view["byteOffset"])
            return found.reshape(-1, width)

        (animation,) = record["animations"]
        place, turn = poses(result, np.arange(len(result.time)))
        seen = set()
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            time = read(sampler["input"])[:, 0] * record["asset"]["extras"]["ms_per_s"]
            assert time == pytest.approx(result.time, abs=1e-5) and result.time[-1] == pytest.approx(
                LASTS * record["asset"]["extras"]["ms_per_s"]
            )
            name, path = record["nodes"][channel["target"]["node"]]["name"], channel["target"]["path"]
            body = result.model.bodies.name.index(name)
            values = read(sampler["output"])
            if path == "translation":
                assert np.abs(values - place[:, body]).max() < 1e-5
            else:
                # the same rotation, and no jump from q to -q
                same = np.abs(np.einsum("tk,tk->t", np.roll(values, 1, axis=1), turn[:, body]))
                assert np.abs(same - 1.0).max() < 1e-6
                assert (np.einsum("tk,tk->t", values[1:], values[:-1]) > 0.0).all()
            seen.add((name, path))
        assert len(seen) == 2 * (boxes(result.model) + len(result.model.rollers))

    @pytest.mark.parametrize("sample", ["peel", "pick"])
    def test_rims_arms_and_meshes_are_where_they_are(self, sample: str) -> None:
        trimesh = pytest.importorskip("trimesh")
        result = ran(sample)
        scene = trimesh.load(io.BytesIO(glb(result, 40)), file_type="glb")
        place, _ = poses(result, np.array([40]))
        for body, name in enumerate(names(result.model)):
            matrix, _ = scene.graph.get(name)
            assert np.abs(matrix[:3, 3] - TURNED @ place[0, body]).max() < 1e-8
        for mesh in machine(result.model):
            shape = scene.geometry[f"{mesh.name} {mesh.kind}"]
            assert shape.is_volume
            assert np.abs(shape.bounds - [mesh.points.min(axis=0), mesh.points.max(axis=0)]).max() < 1e-5

    def test_a_static_run_has_no_animation(self) -> None:
        data = glb(ran("cantilever", "sheets.note.boxes=[2,8]"))
        assert b'"animations"' not in data


class TestVtkhdf:
    @pytest.mark.parametrize("sample", ["transport_4x4", "peel", "channel", "cantilever"])
    def test_vtk_reads_the_same_positions_at_every_time(self, tmp_path: Path, sample: str) -> None:
        reading = pytest.importorskip("vtkmodules.vtkIOHDF", reason="vtk is not installed")
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

        result = {
            "transport_4x4": transport,
            "channel": lambda: ran("channel"),
            "peel": lambda: ran("peel"),
            "cantilever": lambda: ran("cantilever", "sheets.note.boxes=[2,8]"),
        }[sample]()
        path = tmp_path / "run.vtkhdf"
        path.write_bytes(vtkhdf(result))
        assert vtkhdf(result) == path.read_bytes()
        reader = reading.vtkHDFReader()
        reader.SetFileName(str(path))
        assert reader.CanReadFile(str(path))
        reader.UpdateInformation()
        information = reader.GetOutputInformation(0)
        # of one state VTK tells no times
        shown = list(information.Get(Pipeline.TIME_STEPS()) or result.time[:1])
        assert shown == result.time.tolist()
        count, meshes = boxes(result.model), machine(result.model)
        for state in {0, len(shown) // 2, len(shown) - 1}:
            reader.UpdateTimeStep(shown[state])
            grid = reader.GetOutput()
            points = vtk_to_numpy(grid.GetPoints().GetData())
            centres = points[: 8 * count].reshape(count, 8, 3).mean(axis=1)
            # four-byte numbers
            assert np.abs(centres - result.position[state, :count]).max() < 5e-5
            assert grid.GetNumberOfCells() == count + sum(len(mesh.triangles) for mesh in meshes)
            values = {
                grid.GetCellData().GetArrayName(k): vtk_to_numpy(grid.GetCellData().GetArray(k))
                for k in range(grid.GetCellData().GetNumberOfArrays())
            }
            assert set(values) == {"body", "speed", "strain", "curvature", "contact"}
            speed = np.linalg.norm(result.velocity[state, :count], axis=1) * 1000.0
            assert values["speed"][:count] == pytest.approx(speed, rel=1e-6, abs=1e-6)
            assert values["body"][:count].tolist() == list(range(count))
            # of hexahedra the volume tells that the corners stand in the right order
            cell = grid.GetCell(0)
            assert cell.GetCellType() == 12
            lengths = 2.0 * result.model.bodies.half[0]
            edges = [cell.GetPoints().GetPoint(k) for k in (0, 1, 3, 4)]
            sides = [np.subtract(edges[k], edges[0]) for k in (1, 2, 3)]
            assert [np.linalg.norm(s) for s in sides] == pytest.approx(lengths, abs=5e-5)
            assert np.dot(np.cross(sides[0], sides[1]), sides[2]) > 0.0


class TestStills:
    def test_times_are_read_with_units(self) -> None:
        assert times("0,18,30,50ms") == [0.0, 18.0, 30.0, 50.0]
        assert times("0.01 s, 500us") == pytest.approx([10.0, 0.5])
        for bad in ("", "a", "1 mm", "1,,2"):
            with pytest.raises(SpecError, match="--stills"):
                times(bad)

    def test_a_picture_for_each_time(self, result: Result) -> None:
        found = stills(result, [0.0, 30.0])
        assert list(found) == ["still_0ms.png", "still_30ms.png"]
        first, later = (
            np.asarray(Image.open(io.BytesIO(p)).convert("RGB")).astype(int) for p in found.values()
        )
        assert (np.abs(first - later).max(axis=2) > 30).mean() > 0.01
        assert stills(result, [30.0])["still_30ms.png"][:4] == b"\x89PNG"
        with pytest.raises(SpecError, match="0 to 50 ms"):
            stills(result, [60.0])

    def test_the_commands(self, result: Result, tmp_path: Path) -> None:
        run = CliRunner().invoke
        result.save(tmp_path / "run")
        done = run(app, ["report", str(tmp_path / "run"), "--stills", "18,30ms"])
        assert done.exit_code == 0, done.output
        assert {p.name for p in (tmp_path / "run").glob("*.png")} == {"still_18ms.png", "still_30ms.png"}
        assert run(app, ["report", str(tmp_path / "run"), "--stills", "99ms"]).exit_code == 2
        for name, start in (("note.glb", b"glTF"), ("note.vtkhdf", b"\x89HDF")):
            done = run(app, ["export", str(tmp_path / "run"), "-o", str(tmp_path / name)])
            assert done.exit_code == 0, done.output
            assert (tmp_path / name).read_bytes()[:4] == start
        assert run(app, ["export", str(tmp_path / "run"), "-o", str(tmp_path / "note.obj")]).exit_code == 2
