# Written by docs/_generate from the schema of a scene: python docs/_generate
"""Scenes in Python take what a file has: texts with units, numbers, lists, mappings."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from mdlgen.model.tables import Model as Model
from mdlgen.results.compare import Comparison
from mdlgen.results.result import Result as Result
from mdlgen.spec.action import Load as _Load
from mdlgen.spec.action import Probe as _Probe
from mdlgen.spec.action import Support as _Support
from mdlgen.spec.contact import Contact as _Contact
from mdlgen.spec.curve import Curve as _Curve
from mdlgen.spec.friction import Friction as _Friction
from mdlgen.spec.grading import Graded as _Graded
from mdlgen.spec.grading import Grading as _Grading
from mdlgen.spec.guide import Arc as _Arc
from mdlgen.spec.guide import Guide as _Guide
from mdlgen.spec.guide import Line as _Line
from mdlgen.spec.machine import Arm as _Arm
from mdlgen.spec.machine import Drive as _Drive
from mdlgen.spec.machine import OneWay as _OneWay
from mdlgen.spec.machine import Plane as _Plane
from mdlgen.spec.machine import Press as _Press
from mdlgen.spec.machine import Roller as _Roller
from mdlgen.spec.material import Damping as _Damping
from mdlgen.spec.material import Material as _Material
from mdlgen.spec.mesh import Mesh as _Mesh
from mdlgen.spec.motor import Bearing as _Bearing
from mdlgen.spec.motor import Control as _Control
from mdlgen.spec.motor import Limiter as _Limiter
from mdlgen.spec.motor import Motor as _Motor
from mdlgen.spec.motor import Steps as _Steps
from mdlgen.spec.nip import Nip as _Nip
from mdlgen.spec.part import Part as _Part
from mdlgen.spec.rim import Rim as _Rim
from mdlgen.spec.rim import Sector as _Sector
from mdlgen.spec.rows import Mirror as _Mirror
from mdlgen.spec.rows import Repeat as _Repeat
from mdlgen.spec.run import Run as _Run
from mdlgen.spec.scene import Scene as _Scene
from mdlgen.spec.shaft import Shaft as _Shaft
from mdlgen.spec.shape import Curl as _Curl
from mdlgen.spec.shape import DogEar as _DogEar
from mdlgen.spec.shape import Fold as _Fold
from mdlgen.spec.shape import Shape as _Shape
from mdlgen.spec.sheet import Clamp as _Clamp
from mdlgen.spec.sheet import Sheet as _Sheet
from mdlgen.spec.zone import Zone as _Zone

__version__: str

def load(path: str | Path, overrides: Iterable[str] = ()) -> Scene: ...
def loads(text: str, overrides: Iterable[str] = (), folder: str | Path | None = None) -> Scene: ...
def lower(scene: _Scene) -> Model: ...
def emit(model: Model, backend: str = "motionview") -> str: ...
def solve(
    model: Model,
    solver: str = "auto",
    progress: Callable[[float, float, int, int], None] | None = None,
    check_step: bool = False,
) -> Result: ...
def compare(result: Result, other: Result) -> Comparison: ...

class Arc(_Arc):
    def __init__(
        self,
        *,
        center: Sequence[str],
        axis: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float],
        radius: str,
        to: str,
        side: Literal["inside", "outside", "both"],
        **more: Any,
    ) -> None: ...

class Arm(_Arm):
    def __init__(
        self,
        *,
        pivot: Sequence[str],
        mass: str,
        center: Sequence[str] | None = ...,
        inertia: str | None = ...,
        torque: str = ...,
        stiffness: str = ...,
        damping: str = ...,
        start: str = ...,
        start_speed: str = ...,
        stops: Mapping[str, Any] | None = ...,
    ) -> None: ...

class Bearing(_Bearing):
    def __init__(
        self,
        *,
        torque: str = ...,
        drag: str = ...,
        creep: str = ...,
    ) -> None: ...

class Clamp(_Clamp):
    def __init__(
        self,
        *,
        edge: Literal["x_min", "x_max", "y_min", "y_max"],
        length: str = ...,
    ) -> None: ...

class Contact(_Contact):
    def __init__(
        self,
        *,
        name: str | None = ...,
        between: Sequence[str | Sequence[str]] = ...,
        stiffness: str = ...,
        restitution: float | str = ...,
        friction: float | str | Sequence[float | str] | _Friction | Mapping[str, Any] = ...,
        smoothing: str | None = ...,
        rolling_resistance: float | str = ...,
        air: Mapping[str, Any] | None = ...,
        share: Literal["width", "pair"] = ...,
    ) -> None: ...

class Control(_Control):
    def __init__(
        self,
        *,
        proportional: str,
        integral: str = ...,
        limit: str | None = ...,
    ) -> None: ...

class Curl(_Curl):
    def __init__(
        self,
        *,
        radius: str,
        along: Literal["x", "y"],
    ) -> None: ...

class Curve(_Curve):
    def __init__(
        self,
        *,
        points: Sequence[Sequence[float | str]] = ...,
        file: str | None = ...,
        interpolation: Literal["pchip"] = ...,
        extrapolate: Literal["refuse", "linear"] = ...,
    ) -> None: ...

class Damping(_Damping):
    def __init__(
        self,
        *,
        ratio: float | str | None = ...,
        ratio_ty: float | str | None = ...,
        rotation: Literal["inertia", "paper"] | None = ...,
        time: str | Sequence[str] | None = ...,
        loss_factor: float | str | Sequence[float | str] | None = ...,
        at: str | None = ...,
    ) -> None: ...

class DogEar(_DogEar):
    def __init__(
        self,
        *,
        corner: Sequence[Literal["x_min", "x_max"] | Literal["y_min", "y_max"]],
        size: Sequence[str],
        angle: str,
        stiffness: float = ...,
    ) -> None: ...

class Drive(_Drive):
    def __init__(
        self,
        *,
        speed: str | None = ...,
        surface_speed: str | None = ...,
        direction: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float] | None = ...,
        ramp: str = ...,
        profile: Sequence[Sequence[str]] | None = ...,
        motor: _Motor | Mapping[str, Any] | None = ...,
    ) -> None: ...

class Fold(_Fold):
    def __init__(
        self,
        *,
        along: Literal["x", "y"],
        at: str,
        angle: str,
        stiffness: float = ...,
        crease: str | None = ...,
    ) -> None: ...

class Friction(_Friction):
    def __init__(
        self,
        *,
        static: float | str = ...,
        dynamic: float | str = ...,
        stiction_velocity: str | None = ...,
        friction_velocity: str | None = ...,
        stribeck_velocity: str | None = ...,
        md: float | str | None = ...,
        cd: float | str | None = ...,
        front: float | str | None = ...,
        back: float | str | None = ...,
        speed: Sequence[Sequence[str | float]] | None = ...,
        pressure: Mapping[str, Any] | None = ...,
        scatter: Mapping[str, Any] | None = ...,
        sticking: str | None = ...,
        kinetic: float | str = ...,
        mu: float | str = ...,
    ) -> None: ...

class Graded(_Graded):
    def __init__(
        self,
        *,
        sizes: Sequence[float] = ...,
        near: Sequence[str] = ...,
        width: str | None = ...,
        ratio: float | None = ...,
    ) -> None: ...

class Grading(_Grading):
    def __init__(
        self,
        *,
        x: _Graded | Mapping[str, Any] | None = ...,
        y: _Graded | Mapping[str, Any] | None = ...,
    ) -> None: ...

class Guide(_Guide):
    def __init__(
        self,
        *,
        width: str,
        line: _Line | Mapping[str, Any] | None = ...,
        arc: _Arc | Mapping[str, Any] | None = ...,
        thickness: str = ...,
        mass: str = ...,
        edge_radius: str | None = ...,
        pivot: Mapping[str, Any] | None = ...,
        slide: Mapping[str, Any] | None = ...,
    ) -> None: ...

class Limiter(_Limiter):
    def __init__(
        self,
        *,
        torque: str,
        creep: str = ...,
    ) -> None: ...

class Line(_Line):
    def __init__(
        self,
        *,
        to: Sequence[str],
        axis: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float],
        side: Literal["left", "right", "both"],
        **more: Any,
    ) -> None: ...

class Load(_Load):
    def __init__(
        self,
        *,
        sheet: str,
        at: Sequence[str] | None = ...,
        edge: Literal["x_min", "x_max", "y_min", "y_max"] | None = ...,
        force: Sequence[str] | None = ...,
        moment: Sequence[str] | None = ...,
        stress: str | None = ...,
        profile: Sequence[Sequence[str | float]] | None = ...,
    ) -> None: ...

class Material(_Material):
    def __init__(
        self,
        *,
        E_md: str | None = ...,
        E_cd: str | None = ...,
        curve_md: _Curve | Mapping[str, Any] | None = ...,
        curve_cd: _Curve | Mapping[str, Any] | None = ...,
        k_tx: str | None = ...,
        k_ty: str | None = ...,
        k_tz: str | None = ...,
        D_md: str | None = ...,
        D_cd: str | None = ...,
        D_twist: str | None = ...,
        G: str | None = ...,
        poisson: float | str | None = ...,
        damping: _Damping | Mapping[str, Any] = ...,
        **more: Any,
    ) -> None: ...

class Mesh(_Mesh):
    def __init__(
        self,
        *,
        file: str,
        units: Literal["mm", "cm", "m", "in"] = ...,
        center: Sequence[str] = ...,
        rotation: Sequence[str] = ...,
        on: str | None = ...,
        mass: str | None = ...,
        density: str | None = ...,
        at: Literal["nodes", "centres"] = ...,
        edge_radius: str = ...,
        pivot: Mapping[str, Any] | None = ...,
        slide: Mapping[str, Any] | None = ...,
    ) -> None: ...

class Mirror(_Mirror):
    def __init__(
        self,
        *,
        across: Literal["x", "y", "z"],
        at: str = ...,
        names: Sequence[str] = ...,
    ) -> None: ...

class Motor(_Motor):
    def __init__(
        self,
        *,
        torque: str | None = ...,
        speed: str | None = ...,
        table: Sequence[Sequence[str]] | None = ...,
        inertia: str = ...,
        gear: float | str = ...,
        voltage: Sequence[Sequence[str | float]] | None = ...,
        control: _Control | Mapping[str, Any] | None = ...,
        steps: _Steps | Mapping[str, Any] | None = ...,
    ) -> None: ...

class Nip(_Nip):
    def __init__(
        self,
        *,
        at: Sequence[str],
        force: str,
        lower: Mapping[str, Any],
        upper: Mapping[str, Any],
        normal: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float] = ...,
        axis: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float] = ...,
        sheet: str | None = ...,
        contact: Mapping[str, Any] | None = ...,
        repeat: _Repeat | Mapping[str, Any] | None = ...,
        mirror: _Mirror | Mapping[str, Any] | None = ...,
    ) -> None: ...

class OneWay(_OneWay):
    def __init__(
        self,
        *,
        direction: Literal[1, -1],
        torque: str,
        creep: str = ...,
    ) -> None: ...

class Part(_Part):
    def __init__(
        self,
        *,
        external: Literal[True],
        body: str,
        graphics: Sequence[str],
    ) -> None: ...

class Plane(_Plane):
    def __init__(
        self,
        *,
        center: Sequence[str],
        normal: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float],
        size: Sequence[str],
        along: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float] | None = ...,
        mass: str = ...,
        press: _Press | Mapping[str, Any] | None = ...,
        edge_radius: str | None = ...,
        pivot: Mapping[str, Any] | None = ...,
        slide: Mapping[str, Any] | None = ...,
        repeat: _Repeat | Mapping[str, Any] | None = ...,
        mirror: _Mirror | Mapping[str, Any] | None = ...,
    ) -> None: ...

class Press(_Press):
    def __init__(
        self,
        *,
        direction: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float],
        stiffness: str,
        preload: str,
        free_length: str = ...,
        damping_ratio: float | str = ...,
        start: str | None = ...,
        start_speed: str = ...,
        carrier_mass: str | None = ...,
        stops: Mapping[str, Any] | None = ...,
    ) -> None: ...

class Probe(_Probe):
    def __init__(
        self,
        *,
        sheet: str,
        at: Sequence[str] | None = ...,
        edge: Literal["x_min", "x_max", "y_min", "y_max"] | None = ...,
    ) -> None: ...

class Repeat(_Repeat):
    def __init__(
        self,
        *,
        count: int,
        step: Sequence[str],
        names: Sequence[str] | None = ...,
    ) -> None: ...

class Rim(_Rim):
    def __init__(
        self,
        *,
        sectors: Sequence[_Sector | Mapping[str, Any]],
        blend: str = ...,
    ) -> None: ...

class Roller(_Roller):
    def __init__(
        self,
        *,
        center: Sequence[str] = ...,
        axis: Literal["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"] | Sequence[float] = ...,
        radius: str = ...,
        diameter: str | None = ...,
        width: str = ...,
        mass: str = ...,
        drive: _Drive | Mapping[str, Any] | None = ...,
        spin: str = ...,
        one_way: _OneWay | Mapping[str, Any] | None = ...,
        limiter: _Limiter | Mapping[str, Any] | None = ...,
        bearing: _Bearing | Mapping[str, Any] | None = ...,
        press: _Press | Mapping[str, Any] | None = ...,
        arm: _Arm | Mapping[str, Any] | None = ...,
        rim: _Rim | Mapping[str, Any] | None = ...,
        cover: Mapping[str, Any] | None = ...,
        repeat: _Repeat | Mapping[str, Any] | None = ...,
        mirror: _Mirror | Mapping[str, Any] | None = ...,
    ) -> None: ...

class Run(_Run):
    def __init__(
        self,
        *,
        duration: str = ...,
        analysis: Literal["transient", "static"] = ...,
        step: str | None = ...,
        tolerance: float | str = ...,
        limit: str | None = ...,
        print_step: str | None = ...,
        prune: bool = ...,
        symmetry: bool = ...,
        sleep: bool = ...,
        threads: int = ...,
        margin: str = ...,
    ) -> None: ...

class Scene(_Scene):
    def __init__(
        self,
        *,
        name: str,
        sheets: Mapping[str, _Sheet | Mapping[str, Any]],
        author: str | float | None = ...,
        revision: str | float | None = ...,
        gravity: Sequence[str] = ...,
        gravity_profile: Sequence[Sequence[str | float]] | None = ...,
        parameters: Mapping[str, str | float | Mapping[str, Any]] = ...,
        materials: Mapping[str, _Material | Mapping[str, Any]] = ...,
        rollers: Mapping[str, _Roller | Mapping[str, Any]] = ...,
        shafts: Mapping[str, _Shaft | Mapping[str, Any]] = ...,
        nips: Mapping[str, _Nip | Mapping[str, Any]] = ...,
        piles: Mapping[str, Mapping[str, Any]] = ...,
        streams: Mapping[str, Mapping[str, Any]] = ...,
        planes: Mapping[str, _Plane | Mapping[str, Any]] = ...,
        guides: Mapping[str, _Guide | Mapping[str, Any]] = ...,
        meshes: Mapping[str, _Mesh | Mapping[str, Any]] = ...,
        parts: Mapping[str, _Part | Mapping[str, Any]] = ...,
        contacts: Sequence[_Contact | Mapping[str, Any]] | Mapping[str, _Contact | Mapping[str, Any]] = ...,
        defaults: Mapping[str, Any] | None = ...,
        loads: Sequence[_Load | Mapping[str, Any]] = ...,
        run: _Run | Mapping[str, Any] = ...,
        probes: Mapping[str, _Probe | Mapping[str, Any]] = ...,
        require: Sequence[str] = ...,
        supports: Sequence[_Support | Mapping[str, Any]] = ...,
        sensors: Mapping[str, Mapping[str, Any]] = ...,
        rules: Sequence[Mapping[str, Any]] = ...,
    ) -> None: ...
    def with_(self, changes: Mapping[str, Any] | None = None, **more: Any) -> Scene: ...

class Sector(_Sector):
    def __init__(
        self,
        *,
        to: str,
        radius: str | None = ...,
        friction: float = ...,
        stiffness: float = ...,
        restitution: float | None = ...,
        **more: Any,
    ) -> None: ...

class Shaft(_Shaft):
    def __init__(
        self,
        *,
        rollers: Mapping[str, float | str],
        drive: _Drive | Mapping[str, Any] | None = ...,
        inertia: str = ...,
        bearing: _Bearing | Mapping[str, Any] | None = ...,
    ) -> None: ...

class Shape(_Shape):
    def __init__(
        self,
        *,
        start: Literal["bent", "flat"] = ...,
        curl: _Curl | Mapping[str, Any] | None = ...,
        folds: Sequence[_Fold | Mapping[str, Any]] = ...,
        dog_ears: Sequence[_DogEar | Mapping[str, Any]] = ...,
    ) -> None: ...

class Sheet(_Sheet):
    def __init__(
        self,
        *,
        material: str = ...,
        size: Sequence[str] = ...,
        thickness: str = ...,
        mass: str = ...,
        grammage: str | None = ...,
        density: str | None = ...,
        boxes: Sequence[int] = ...,
        layout: Literal["edge_to_edge", "center_to_center", "plate"] = ...,
        grid: Literal["tiled", "paper"] = ...,
        grading: _Grading | Mapping[str, Any] | None = ...,
        zones: Mapping[str, _Zone | Mapping[str, Any]] = ...,
        shape: _Shape | Mapping[str, Any] | None = ...,
        center: Sequence[str] = ...,
        turn: str | None = ...,
        rotation: Sequence[str] | None = ...,
        velocity: Sequence[str] = ...,
        spin: Sequence[str] = ...,
        clamp: _Clamp | Mapping[str, Any] | None = ...,
        surface: bool = ...,
        enters: str = ...,
        by_rule: bool = ...,
        out: str | Sequence[str] = ...,
    ) -> None: ...

class Steps(_Steps):
    def __init__(
        self,
        *,
        per_turn: int = ...,
        damping: str = ...,
    ) -> None: ...

class Support(_Support):
    def __init__(
        self,
        *,
        sheet: str,
        fix: Sequence[Literal["x", "y", "z"]],
        at: Sequence[str] | None = ...,
        edge: Literal["x_min", "x_max", "y_min", "y_max"] | None = ...,
    ) -> None: ...

class Zone(_Zone):
    def __init__(
        self,
        *,
        x: Sequence[str],
        y: Sequence[str],
        thickness: str | None = ...,
        density: float = ...,
        stiffness: float = ...,
        friction: float = ...,
    ) -> None: ...
