"""Shafts: several rollers that turn together, or by the ratios of gears and toothed belts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from pydantic import Field, model_validator

from mdlgen.spec.between import known
from mdlgen.spec.drive import Drive
from mdlgen.spec.fields import Name
from mdlgen.spec.motor import Bearing, Inertia
from mdlgen.spec.quantities import default, ratio
from mdlgen.spec.strict import Strict, fail

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene


class Shaft(Strict):
    """Several rollers that one shaft turns. A torque that slows one of them loads the others."""

    rollers: dict[Name, Annotated[float, ratio(-1000.0, 1000.0)]] = Field(
        description="its rollers, each with its turns about its own axis for one turn of the shaft; below 0 "
        "the other way"
    )
    drive: Drive | None = Field(
        default=None, description="prescribed speed or a motor; without it the shaft turns freely"
    )
    inertia: Inertia = Field(default=default("0 g*mm^2"), description="moment of inertia of the shaft itself")
    bearing: Bearing | None = Field(
        default=None, description="friction and drag of all its bearings together, at the speed of the shaft"
    )

    @model_validator(mode="after")
    def _turns(self) -> Shaft:
        if not self.rollers:
            raise fail("a shaft needs a roller, as rollers: {feed: 1, nip: 1.5}", within=("rollers",))
        for name, value in self.rollers.items():
            if value == 0.0:
                raise fail("the ratio is 0; give one other than 0", within=("rollers", name))
        if self.drive is not None and self.drive.surface_speed is not None:
            message = "a shaft has no surface; give speed or profile"
            raise fail(message, within=("drive", "surface_speed"))
        if self.drive is not None and self.drive.motor is None:
            for key in ("bearing", "inertia"):
                if getattr(self, key):
                    raise fail(
                        f"a shaft with a prescribed speed has no use for {key}; leave it out, or give the "
                        "drive a motor",
                        within=(key,),
                    )
        return self

    @property
    def prescribed(self) -> bool:
        """True if its speed is prescribed, whatever torque that takes."""
        return self.drive is not None and self.drive.motor is None


def check_shaft(scene: Scene, name: str) -> None:
    """Raises the error for a roller that is not there, or that has what a shaft has."""
    shaft, path = scene.shafts[name], ("shafts", name, "rollers")
    for roller in shaft.rollers:
        known(roller, scene.rollers, "roller", (*path, roller))
        part = scene.rollers[roller]
        other = next((n for n, s in scene.shafts.items() if n != name and roller in s.rollers), None)
        if other is not None:
            raise fail(f"roller {roller} is also on shaft {other}; a roller has one shaft", (*path, roller))
        keys = ["drive", "arm", "bearing"]
        if not shaft.prescribed:
            keys += ["one_way", "limiter"]
        for key in keys:
            if getattr(part, key) is not None:
                hint = {
                    "drive": "the shaft has the drive",
                    "arm": "a roller on an arm is on no shaft",
                    "bearing": "the shaft has the bearing",
                }.get(
                    key, "that goes with a shaft of prescribed speed, not with one that has a motor or none"
                )
                raise fail(f"roller {roller} of shaft {name}: {hint}", ("rollers", roller, key))
    if scene.run.analysis == "static":
        raise fail(f"shaft {name}: shafts turn, and a static analysis has no speed", ("shafts", name))
