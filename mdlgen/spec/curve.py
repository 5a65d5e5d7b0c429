"""A measured stress-strain curve of a material: points, inline or from a file in the folder of the spec."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Field,
    GetJsonSchemaHandler,
    ValidationInfo,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import CoreSchema

from mdlgen.errors import OutputError
from mdlgen.paths import read_at_most
from mdlgen.spec.beside import beside
from mdlgen.spec.limits import Tally
from mdlgen.spec.quantities import quantity
from mdlgen.spec.strict import Strict, fail

BYTES = 200  # of a file for each point that is allowed
MAX_STRAIN = 1.0

_PERCENT = re.compile(r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(%?)\s*")
_HEADER = re.compile(r"\s*[A-Za-z_ ]+\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
_STRESS = quantity("MPa", 0.0)


def _strain(value: Any) -> Any:
    """A plain number, or text in per cent."""
    if isinstance(value, str):
        match = _PERCENT.fullmatch(value[:100])
        if not match or not match[2]:
            raise fail(f"{value[:60]!r} is not a strain; write a plain number (0.012), or per cent ('1.2 %')")
        value = float(match[1]) / 100
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise fail(f"{value!r} is not a strain; write a plain number (0.012), or per cent ('1.2 %')"[:200])
    if not 0.0 <= value <= MAX_STRAIN:
        raise fail(
            f"a strain of {value:g} is {100 * value:g} %; allowed 0 to {MAX_STRAIN:g}, in tension alone"
        )
    return float(value)


def _pair(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"expected [strain, stress] like [0.012, '31 MPa'], got {value!r}"[:200])
    return tuple(value)


Strain = Annotated[
    float,
    BeforeValidator(_strain),
    WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string"}], "examples": [0.012, "1.2 %"]}),
]
Stress = Annotated[float, _STRESS]
Point = Annotated[tuple[Strain, Stress], BeforeValidator(_pair)]


class Curve(Strict):
    """Stress over strain in tension, from (0, 0); compression follows the same curve with both signs changed.

    Between points and their mirror images the curve is the monotone cubic of Fritsch and Carlson (PCHIP).
    """

    points: tuple[Point, ...] = Field(
        strict=False,
        description="[strain, stress] from [0, 0 MPa] on, strains increasing, stresses never decreasing",
    )
    file: str | None = Field(
        default=None,
        exclude=True,  # of what is dumped: the points are there
        description="in place of points: a CSV file of strain and stress, in the folder of the spec or below",
    )
    interpolation: Literal["pchip"] = Field(
        default="pchip", description="between points: monotone cubic, continuous slope"
    )
    extrapolate: Literal["refuse", "linear"] = Field(
        default="refuse",
        description="beyond the last point: refuse ends a run, naming the joint; linear continues with the "
        "slope at that point",
    )

    @model_validator(mode="before")
    @classmethod
    def _read(cls, data: Any, info: ValidationInfo) -> Any:
        if isinstance(data, (list, tuple)):
            data = {"points": data}
        if not isinstance(data, dict):
            raise fail(f"expected a list of [strain, stress], or points or file, got {data!r}"[:200])
        data = {key: value for key, value in data.items() if key != "file" or value is not None}
        if ("points" in data) == ("file" in data):
            raise fail("give exactly one of points and file")
        given = info.context or {}
        tally = given.get("tally") or Tally()
        points = _file_points(*beside(data["file"], info), tally) if "file" in data else data["points"]
        if isinstance(points, (list, tuple)):
            if much := tally.exceeded("points", len(points), "points of curves"):
                raise fail(much)
            tally.add("points", len(points))
        return {**data, "points": points}

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        whole = handler.resolve_ref_schema(handler(schema))
        whole.pop("required", None)
        whole["oneOf"] = [{"required": ["points"]}, {"required": ["file"]}]
        return {"anyOf": [whole, whole["properties"]["points"]]}

    @model_validator(mode="after")
    def _grows(self) -> Curve:
        if len(self.points) < 2:
            raise fail("a curve has at least two points, the first [0, 0 MPa]")
        if self.points[0] != (0.0, 0.0):
            raise fail("the first point must be [0, 0 MPa]: a sheet is without stress at the start")
        for k, ((e0, s0), (e1, s1)) in enumerate(zip(self.points, self.points[1:], strict=False), 1):
            if not e1 > e0:
                raise fail(f"point {k}: the strain {e1:g} is not above the one before, {e0:g}")
            if s1 < s0:
                raise fail(
                    f"point {k}: the stress falls from {s0:g} to {s1:g} MPa, and a joint that softens so has "
                    "no unique state; end the curve where its stress is greatest"
                )
        if not self.points[1][1] > 0.0:
            raise fail("point 1: the stress is 0; the curve needs a slope above 0 at the start")
        return self

    @property
    def modulus(self) -> float:
        """Slope at the start [MPa]: that of the first two points, since the curve is odd."""
        (_, _), (strain, stress) = self.points[:2]
        return stress / strain


def _file_points(name: Any, folder: Any, tally: Tally) -> list[tuple[float, str]]:
    """Points of a CSV file; raises the error that names file and line."""
    if not isinstance(name, str) or not name.strip():
        raise fail(f"file is the name of a CSV file, got {name!r}"[:200])
    if folder is None:
        raise fail(f"{name}: only a scene that is itself read from a file can name one")
    path = Path(name)
    inside = found = Path(folder).resolve()
    if path.is_absolute() or ".." in path.parts or "\\" in name:
        raise fail(f"{name}: a curve's file stands in the folder of the spec or below; name it from there")
    try:
        found = (inside / path).resolve()
        if not found.is_relative_to(inside):
            raise OutputError(f"{found}: leads out of the folder of the spec")
        raw = read_at_most(found, BYTES * tally.limits.points + 1, named=True)
        text = raw.decode("utf-8-sig")
    except OutputError as error:  # with the name as it stands in the spec
        raise fail(f"{name}: {str(error).removeprefix(f'{found}: ')}"[:300]) from None
    except (OSError, ValueError) as error:
        raise fail(f"{name}: cannot read: {getattr(error, 'strerror', None) or error}"[:300]) from None
    if much := tally.exceeded("points", len(raw), f"{name}: {BYTES} bytes to a point", BYTES):
        raise fail(much)
    tally.add("points", len(raw), BYTES)
    return _rows(text, name, tally)


def _rows(text: str, name: str, tally: Tally) -> list[tuple[float, str]]:
    """(strain, stress) of each line; a first line may name the columns and their units."""
    rows: list[tuple[float, str]] = []
    units = ("", "")
    first = True
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        cells = [cell.strip().strip('"').strip() for cell in re.split(r"[,;\t]", line)]
        here = f"{name}:{number}"
        if len(cells) != 2:
            raise fail(f"{here}: expected strain and stress, got {len(cells)} values")
        heads = [_HEADER.fullmatch(cell) for cell in cells]
        if first and heads[0] and heads[1]:
            units = (heads[0][1] or "", heads[1][1] or "")
            if units[0] not in ("", "-", "1", "%"):
                raise fail(f"{here}: strain in {units[0]!r}; allowed: nothing, or %")
            first = False
            continue
        first = False
        percent = f"{cells[0]} %" if units[0] == "%" and "%" not in cells[0] else cells[0]
        stress = f"{cells[1]} {units[1]}" if units[1] and _PERCENT.fullmatch(cells[1]) else cells[1]
        try:
            strain = _strain(percent if "%" in percent else float(percent))
            _STRESS.read(stress)
        except ValueError as error:
            report = getattr(error, "message", None)
            what = report() if callable(report) else f"{percent!r} is not a strain"
            raise fail(f"{here}: {what}") from None
        rows.append((strain, stress))
        if much := tally.exceeded("points", len(rows), f"{name}: points"):
            raise fail(much)
    return rows
