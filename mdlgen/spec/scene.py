"""A scene: sheets, machine, contacts and requirements."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    PrivateAttr,
    SerializationInfo,
    SerializerFunctionWrapHandler,
    ValidationInfo,
    field_validator,
    model_serializer,
    model_validator,
)
from pydantic_core import PydanticCustomError

from mdlgen.formulas import Amount
from mdlgen.spec.action import Load, Probe, Support
from mdlgen.spec.beside import PYTHON, holding, named_from
from mdlgen.spec.between import find_pairs
from mdlgen.spec.consistency import check_counts, check_names, checks
from mdlgen.spec.contact import Contact, of_covers
from mdlgen.spec.covered import with_stiffness
from mdlgen.spec.document import Document
from mdlgen.spec.dump import in_plain_data, said
from mdlgen.spec.fields import Acceleration, Name, Words
from mdlgen.spec.guide import Guide
from mdlgen.spec.limits import DEFAULT, Limits
from mdlgen.spec.machine import Plane, Roller
from mdlgen.spec.machine_part import MachinePart, classes_of
from mdlgen.spec.material import Material
from mdlgen.spec.mesh import Mesh
from mdlgen.spec.nip import Nip
from mdlgen.spec.over_time import WORDS, Profile
from mdlgen.spec.parameter import (
    MOST as MOST_PARAMETERS,
)
from mdlgen.spec.parameter import (
    NO_PARAMETERS,
    Parameters,
    ParameterValue,
    current,
    formulas_of,
    of_scene,
    without_formulas,
)
from mdlgen.spec.part import Part
from mdlgen.spec.pile import Pile
from mdlgen.spec.pile import names_of as sheets_of
from mdlgen.spec.quantities import default
from mdlgen.spec.rule import Rule
from mdlgen.spec.run import Run
from mdlgen.spec.sensor import Sensor
from mdlgen.spec.shaft import Shaft
from mdlgen.spec.sheet import Sheet
from mdlgen.spec.shorthand import Defaults, written_out
from mdlgen.spec.source import Source, text_of, text_of_data
from mdlgen.spec.stream import Stream
from mdlgen.spec.strict import Strict, fail, fail_all
from mdlgen.spec.surface import with_rates

if TYPE_CHECKING:
    from mdlgen.lints.lint import Lint
    from mdlgen.study.inline import Runs


def _list_or_names(schema: dict[str, Any]) -> None:
    """A list, or a mapping of names, in the JSON schema."""
    items = schema.pop("items")
    kind = schema.pop("type")
    schema["anyOf"] = [
        {"type": kind, "items": items},
        {"type": "object", "additionalProperties": items},
    ]


class Scene(Strict):
    """Everything that a user describes; see `mdlgen schema` for each field."""

    name: Name = Field(description="name of the scene and of the files made from it")
    author: Words | None = Field(default=None, description="who designs it, for the head of the report")
    revision: Words | None = Field(
        default=None, description="state of the design, as B or 2026-11, for the head of the report"
    )
    gravity: Acceleration = Field(
        default=(default("0 m/s^2"), default("0 m/s^2"), default("-9.81 m/s^2")),
        description="acceleration of gravity, global axes",
    )
    gravity_profile: Profile | None = Field(
        default=None, description=f"what gravity is multiplied by over time: {WORDS}; 1 where left out"
    )
    parameters: dict[Name, ParameterValue] = Field(
        default_factory=dict,
        description="named values; every quantity may be a formula over them, as -radius - gap/2. "
        "{value: 3 N, range: [1 N, 5 N]} gives the range of a slider, too",
    )
    materials: dict[Name, Material] = Field(
        default_factory=dict, description="sheet materials by name; a sheet names one of them"
    )
    sheets: dict[Name, Sheet] = Field(min_length=1, description="sheets by name, one at least")
    rollers: dict[Name, Roller] = Field(default_factory=dict, description="rollers by name")
    shafts: dict[Name, Shaft] = Field(
        default_factory=dict, description="shafts that turn several rollers together, by name"
    )
    nips: dict[Name, Nip] = Field(
        default_factory=dict,
        description="pairs of rollers that grip a sheet, placed in balance with their contacts, by name",
    )
    piles: dict[Name, Pile] = Field(
        default_factory=dict, description="sheets that lie on each other, with their contacts, by name"
    )
    streams: dict[Name, Stream] = Field(
        default_factory=dict, description="sheets that come in one after another, by name"
    )
    planes: dict[Name, Plane] = Field(default_factory=dict, description="flat plates by name")
    guides: dict[Name, Guide] = Field(
        default_factory=dict, description="fixed plates that lead sheets, straight or bent to an arc, by name"
    )
    meshes: dict[Name, Mesh] = Field(
        default_factory=dict, description="parts whose shape is an STL or OBJ file, by name"
    )
    parts: dict[Name, Part] = Field(
        default_factory=dict, description="bodies of your own MotionView model, by name"
    )
    contacts: tuple[Contact, ...] = Field(
        default=(),
        strict=False,
        description="which parts can touch, and how, as a list or by name; parts without a contact pass "
        "through each other",
        json_schema_extra=_list_or_names,
    )
    defaults: Defaults | None = Field(
        default=None, description="values of keys that contacts and rollers leave out"
    )
    loads: tuple[Load, ...] = Field(default=(), strict=False, description="forces and moments on sheets")
    run: Run = Field(default_factory=Run, description="duration, analysis and accuracy")
    probes: dict[Name, Probe] = Field(
        default_factory=dict, description="points of sheets whose motion is recorded, by name"
    )
    require: tuple[str, ...] = Field(
        default=(),
        strict=False,
        description="what the scene has to do, a text each: no jam, no stub at guide_1, yaw within 1 deg, "
        "speed above 400 mm/s at 30 ms, rollers.motor.nip_force from 2.5 N to 3.5 N throughout; run judges "
        "each, and exit code 6 says that one is missed",
    )
    supports: tuple[Support, ...] = Field(
        default=(), strict=False, description="points of sheets that are held"
    )
    sensors: dict[Name, Sensor] = Field(
        default_factory=dict, description="what sees whether a sheet is at a place, by name"
    )
    rules: tuple[Rule, ...] = Field(
        default=(), strict=False, description="what the machine does when a condition comes true"
    )
    _limits: Limits = PrivateAttr(default=DEFAULT)
    _source: Source = PrivateAttr(default_factory=Source)
    _amounts: dict[str, Amount] = PrivateAttr(default_factory=dict)
    _ranges: dict[str, tuple[float, float]] = PrivateAttr(default_factory=dict)
    _formulas: dict[tuple[str | int, ...], str] = PrivateAttr(default_factory=dict)
    _contacts_made: int = PrivateAttr(default=0)
    _sheets_of_piles: dict[str, Any] = PrivateAttr(default_factory=dict)

    @classmethod
    def machine_tables(cls) -> tuple[str, ...]:
        """Names of the tables of parts of the machine that have a body, in the order of their bodies."""
        return tuple(classes_of(cls))

    @property
    def machine(self) -> dict[str, MachinePart]:
        """All parts of the machine that have a body, by name, in the order of their bodies."""
        tables = (getattr(self, name) for name in self.machine_tables())
        return {name: part for table in tables for name, part in table.items()}

    @property
    def amounts(self) -> dict[str, Amount]:
        """The values of the parameters."""
        return self._amounts

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """The ranges of sliders of the parameters that have one, in internal units."""
        return self._ranges

    @property
    def formulas(self) -> dict[tuple[str | int, ...], str]:
        """The values that are formulas: where each stands, and its text."""
        return self._formulas

    @property
    def contacts_made(self) -> int:
        """Number of contacts that nips and piles make; they are the last ones."""
        return self._contacts_made

    @property
    def sheets_of_piles(self) -> dict[str, Any]:
        """The sheets that piles and streams are of, as they are written: no sheet has their names."""
        return self._sheets_of_piles

    @property
    def limits(self) -> Limits:
        """The limits on the size of the scene; they are not written out."""
        return self._limits

    def with_(self, changes: Mapping[str, Any] | None = None, **more: Any) -> Scene:
        """The scene with other values, by dotted path as of `--set`.

        `{"rollers.motor.drive.speed": "60 rad/s"}`; a path may have patterns. Values that follow from a
        changed value are computed again. Raises SpecError.
        """
        from mdlgen.spec.load import meant

        overrides = [f"{path}={json.dumps(value)}" for path, value in {**(changes or {}), **more}.items()]
        return meant(self._document(), overrides, self._folder_of_names(), self._limits)

    def check(self) -> list[Lint]:
        """The lints of `mdlgen check`: inputs that are allowed, but probably not meant. Each has `code`,
        `where`, `message` and `remedy`. Raises SpecError."""
        from mdlgen.checks import lints
        from mdlgen.model.lower import lower
        from mdlgen.results.required import check

        model = lower(self)
        check(model)
        return lints(model)

    def sweep(
        self, over: Mapping[str, Sequence[object]], measure: Sequence[str] = (), solver: str = "auto"
    ) -> Runs:
        """Run every combination of other values, one after the other; `mdlgen sweep` uses all processors.

        `over` is values by dotted path, `{"contacts.0.friction": [0.1, 0.3]}`; `measure` is expressions as of
        `--measure`, travel, speed and yaw of the sheets where left out. Raises SpecError for a measure that
        there is not; a case that cannot be run is a row with its reason.
        """
        from mdlgen.study.inline import sweep

        return sweep(self, over, measure, solver)

    def to_yaml(self, folder: str | Path | None = None) -> str:
        """The scene as the text of a file. One that came from a file has its comments, formulas and
        shorthand; another one has each value in the unit of its key.

        `folder` is where the text is to stand: files of meshes and curves are named from there. Where it is
        left out that is `folder` of the scene; `loads(text, folder=..)` reads the same scene again. Raises
        SpecError for a file that is not in that folder or below.
        """
        own, document = self._folder_of_names(), self._document()
        base = Path(folder) if folder is not None else self.folder if own == PYTHON else None
        if base is not None:
            named_from(base, document.data, own)
        return text_of(document) if document.text else text_of_data(document.data)

    @property
    def folder(self) -> Path | None:
        """Folder from which `to_yaml` names the files of meshes and curves: that of the scene's file, or, for
        a scene made in Python, the nearest one in which or below which they all are; None: it names none."""
        own = self._folder_of_names()
        return own if own != PYTHON else holding(self._document().data)

    def _folder_of_names(self) -> Path | None:
        return self._source.folder

    def _document(self) -> Document:
        """A copy of the data that the scene was read from, or made of in Python, for changes."""
        assert self._source.document is not None, "set as the scene is validated"
        return self._source.document.copy()

    def __repr__(self) -> str:
        kinds = ("sheets", *self.machine_tables(), "parts", "contacts", "loads", "probes", "supports")
        message = ", ".join(f"{len(getattr(self, kind))} {kind}" for kind in kinds if getattr(self, kind))
        return f"<Scene {self.name}: {message}>"

    @model_validator(mode="wrap")
    @classmethod
    def _with_parameters(cls, value: Any, handler: ModelWrapValidatorHandler[Scene], info: ValidationInfo):
        """The scene of what is written out, whose formulas are over its parameters."""
        if not isinstance(value, dict):
            return handler(value)
        context = info.context or {}
        made = "origins" not in context  # in Python: load has the document of its text
        value = in_plain_data(value) if made else value
        given = value.get("parameters")
        parameters = Parameters(given) if isinstance(given, dict) else NO_PARAMETERS
        origins = context.get("origins", {})
        plain = {**value, "parameters": parameters.given} if parameters.given else value
        with of_scene(parameters):
            written = written_out(plain, origins)
            with of_covers(written):
                scene = handler(written)
        scene._amounts, scene._ranges = parameters.amounts, parameters.ranges
        scene._contacts_made = sum(
            key[0] == "contacts" and len(key) == 2 and path[0] in ("nips", "piles")
            for key, path in origins.items()
        )
        sheets = value.get("sheets")
        if isinstance(sheets, dict):
            of = {some.of for some in (*scene.piles.values(), *scene.streams.values())}
            of |= {sheet for name, pile in scene.piles.items() for sheet in sheets_of(name, vars(pile))}
            scene._sheets_of_piles = {name: sheet for name, sheet in sheets.items() if name in of}
        if made:
            scene._source = Source(Document(value, {}, {}, scene.name), PYTHON)
        return scene

    @model_serializer(mode="wrap")
    def _said(self, handler: SerializerFunctionWrapHandler, info: SerializationInfo) -> dict[str, Any]:
        return said(self, handler(self), info)

    @model_validator(mode="after")
    def _references(self, info: ValidationInfo) -> Scene:
        self._limits = (info.context or {}).get("limits", DEFAULT)
        check_counts(self)
        check_names(self)
        errors: list[PydanticCustomError] = []
        for check in checks(self):
            try:
                check()
            except PydanticCustomError as error:
                errors.append(error)
        pairs, wrong = find_pairs(self)
        if errors or wrong:
            raise fail_all([*errors, *wrong])
        with_rates(self, pairs)
        if any(roller.cover is not None for roller in self.rollers.values()):
            with_stiffness(self, pairs)
        self._formulas = dict(formulas_of(self))
        for name in type(self).model_fields if self._formulas else ():
            vars(self)[name] = without_formulas(getattr(self, name))
        return self

    @field_validator("parameters", mode="wrap")
    @classmethod
    def _evaluated(cls, value: Any, handler: Callable[[Any], Any]) -> Any:
        """Names of the form that parts have too, and for each the error of its value."""
        found = handler(value)
        parameters = current()
        if len(found) > MOST_PARAMETERS:
            raise fail(f"{len(found)} parameters; allowed are {MOST_PARAMETERS}")
        lower: dict[str, str] = {}
        wrong = [fail(message, ("parameters", name)) for name, message in parameters.own.items()]
        wrong += [fail(text, ("parameters", name, "range")) for name, text in parameters.wrong_ranges.items()]
        for name in found:
            if lower.setdefault(name.lower(), name) != name:
                message = f"the name {name!r} is used twice (also {lower[name.lower()]})"
                wrong.append(fail(message, ("parameters", name)))
        if wrong:
            raise fail_all(wrong)
        return found

    def contact_pairs(self) -> list[tuple[int, str, str]]:
        """(index of the contact, part a, part b) for every pair of parts, sheets and rollers first.

        Raises the error for a part that does not exist, a pair given twice, or one that is not modelled.
        """
        pairs, errors = find_pairs(self)
        if errors:
            raise fail_all(errors)
        return pairs
