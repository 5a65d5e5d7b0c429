"""Checks across a scene: names that are used exist, names are not used twice, counts are within the
limits."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mdlgen.spec.action import OnSheet
from mdlgen.spec.between import known
from mdlgen.spec.nip import names_of as rollers_of
from mdlgen.spec.over_time import begun
from mdlgen.spec.passing import as_written, check_passing, check_stream, passing_sheets
from mdlgen.spec.pile import names_of as sheets_of
from mdlgen.spec.reacting import checks as reacting
from mdlgen.spec.reacting import leaves
from mdlgen.spec.require import OF_SHEETS, requirement
from mdlgen.spec.shaft import check_shaft
from mdlgen.spec.strict import fail
from mdlgen.units import exact_quantity

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene


def checks(scene: Scene) -> Iterator[Callable[[], None]]:
    """The checks of a scene, one by one, so that each mistake is reported."""
    for name in scene.sheets:
        yield partial(_check_material, scene, name)
    for kind in ("probes", "loads", "supports"):
        items = getattr(scene, kind)
        for key, item in items.items() if isinstance(items, dict) else enumerate(items):
            yield partial(_on_sheet, scene, item, (kind, key))
    for name in scene.rollers:
        yield partial(_check_clutch, scene, name)
        yield partial(_check_start, scene, name)
    for name in scene.shafts:
        yield partial(check_shaft, scene, name)
    for name in scene.nips:
        yield partial(_check_nip, scene, name)
    yield partial(_check_weight, scene)
    for name in scene.piles:
        yield partial(_check_pile, scene, name)
    for name in scene.streams:
        yield partial(check_stream, scene, name)
    for name in passing_sheets(scene):
        yield partial(check_passing, scene, name)
    for name, mesh in scene.meshes.items():
        if mesh.on is not None:
            yield partial(known, mesh.on, scene.rollers, "roller", ("meshes", name, "on"))

    for k in range(len(scene.require)):
        yield partial(_check_requirement, scene, k)
    yield from reacting(scene)


def _check_requirement(scene: Scene, k: int) -> None:
    path = ("require", k)
    try:
        wanted = requirement(scene.require[k])
    except ValueError as error:
        raise fail(str(error), path) from None
    if wanted.state in OF_SHEETS and wanted.part is not None:
        known(wanted.part, (*scene.sheets, *scene.streams), "sheet or stream", path)
        if wanted.state == "left":
            leaves(scene, wanted.part, path)
    elif wanted.state is not None and wanted.part is not None:
        known(wanted.part, scene.sensors, "sensor", path)
    elif wanted.part is not None:
        parts = [*scene.sheets, *scene.machine, *scene.sensors]
        known(wanted.part, parts, "part", path)
    if wanted.sensor is not None:
        known(wanted.sensor, scene.sensors, "sensor", path)


def _check_nip(scene: Scene, name: str) -> None:
    nip, path = scene.nips[name], ("nips", name)
    sheets = as_written(scene)
    if nip.sheet is not None:
        known(nip.sheet, sheets, "sheet", (*path, "sheet"))
    elif len({sheets[sheet] for sheet in scene.sheets}) > 1:
        raise fail(f"which sheet is between them? give sheet, as sheet: {next(iter(sheets))}", path)
    rollers = rollers_of(name, {"lower": nip.lower, "upper": nip.upper})
    if all(scene.rollers[roller].press is not None for roller in rollers):
        raise fail("both rollers have a press; give one of them a fixed axis", (*path, "upper", "press"))
    for side, roller in zip(("lower", "upper"), rollers, strict=True):
        press = getattr(nip, side).get("press")
        if isinstance(press, dict) and "preload" in press:
            message = (
                f"the preload of {roller} follows from the force of nip {name}; leave it out, "
                f"and give that, as force: {exact_quantity(nip.force, 'N')}"
            )
            raise fail(message, (*path, side, "press", "preload"))
        given = getattr(nip, side).get("contact")
        if isinstance(given, dict) and given.get("share", "width") != "width":
            message = "a nip is in balance with share: width only; leave share out"
            raise fail(message, (*path, side, "contact", "share"))


def _check_weight(scene: Scene) -> None:
    if scene.nips and begun(scene.gravity_profile) != 1.0:
        raise fail(
            "the press of a nip follows from its force and from gravity as given; begin with a factor of 1",
            ("gravity_profile", 0, 1),
        )


def _check_pile(scene: Scene, name: str) -> None:
    pile, path = scene.piles[name], ("piles", name)
    lowest = sheets_of(name, {"count": 1})[0]
    if lowest not in scene.sheets:
        known(pile.of, scene.sheets, "sheet", (*path, "of"))
    if scene.sheets[lowest].clamp is not None:
        message = f"sheet {pile.of} is clamped: leave clamp out, or all sheets of the pile would be"
        raise fail(message, ("sheets", lowest, "clamp"))
    for key in ("between", "name"):
        if key in pile.contact:
            message = f"leave {key} out: the contacts of a pile are of each sheet and the next one"
            raise fail(message, (*path, "contact", key))


def _check_material(scene: Scene, name: str) -> None:
    sheet = scene.sheets[name]
    known(sheet.material, scene.materials, "material", ("sheets", name, "material"))
    material = scene.materials[sheet.material]
    if material.D_twist is not None and sheet.layout == "edge_to_edge":
        raise fail(
            f"sheet {name}: D_twist acts with layouts plate and center_to_center only: in "
            "edge_to_edge the two corner bushings lock the twist; leave D_twist out or "
            "change the layout",
            ("materials", sheet.material, "D_twist"),
        )
    if material.G is not None and sheet.layout != "plate":
        raise fail(
            f"sheet {name}: G acts with layout plate only: in {sheet.layout} shear goes with the "
            "membrane stiffness across the joint; leave G out or change the layout",
            ("materials", sheet.material, "G"),
        )

    if material.poisson and sheet.layout != "plate":
        raise fail(
            f"sheet {name}: poisson acts with layout plate only: {sheet.layout} does not couple joints along "
            "x and along y; leave poisson out or change the layout",
            ("materials", sheet.material, "poisson"),
        )
    if material.poisson:
        md, cd = material.strips(sheet.thickness, sheet.pitch[0] / sheet.pitch[1])
        if not md > 0.0 or not cd > 0.0:
            raise fail(
                f"sheet {name}: poisson needs a bending stiffness along x and y above 0",
                ("materials", sheet.material, "poisson"),
            )
        try:
            material.bound("D", md, cd)
        except PydanticCustomError as error:
            text = str((error.context or {})["text"])
            raise fail(f"sheet {name}: {text}", ("materials", sheet.material, "poisson")) from None


def _check_clutch(scene: Scene, name: str) -> None:
    if scene.rollers[name].one_way is not None and scene.run.analysis == "static":
        raise fail(
            f"roller {name}: one_way acts by speed, and a static analysis has none; leave it out",
            ("rollers", name, "one_way"),
        )
    roller = scene.rollers[name]
    acts = {"limiter": roller.limiter, "bearing": roller.bearing}
    acts["drive"] = roller.drive.motor if roller.drive is not None else None
    for key, given in acts.items():
        if given is not None and scene.run.analysis == "static":
            word = "a motor" if key == "drive" else key
            raise fail(
                f"roller {name}: {word} acts by speed, and a static analysis has none; leave it out",
                ("rollers", name, key),
            )


def _check_start(scene: Scene, name: str) -> None:
    """Speeds that a roller begins with, and its arm where that carries a mesh."""
    roller, path = scene.rollers[name], ("rollers", name)
    speeds: dict[tuple[str, ...], float] = {("spin",): roller.spin}
    if roller.press is not None:
        speeds["press", "start_speed"] = roller.press.start_speed
    if roller.arm is not None:
        speeds["arm", "start_speed"] = roller.arm.start_speed
    for place, speed in speeds.items():
        if speed != 0.0 and scene.run.analysis == "static":
            raise fail("a static analysis has no speeds; leave it out", (*path, *place))
    if roller.arm is not None and roller.arm.start != 0.0:
        on = [key for key, mesh in scene.meshes.items() if mesh.on == name]
        if on:
            raise fail(
                f"the mesh {on[0]} is on this roller, and is not turned with its arm; give the center of "
                "the roller where it begins, and leave start out",
                (*path, "arm", "start"),
            )


def check_counts(scene: Scene) -> None:
    boxes = sum(sheet.boxes[0] * sheet.boxes[1] for sheet in scene.sheets.values())
    if message := scene.limits.exceeded("boxes", boxes, "boxes of all sheets"):
        raise fail(message, ("sheets",))
    if scene.run.analysis == "transient" and scene.run.print_step is not None:
        bodies = boxes + len(scene.machine)
        stored = bodies * scene.run.duration / scene.run.print_step
        if message := scene.limits.exceeded("states", stored, "states stored (bodies times outputs)"):
            raise fail(message, ("run", "print_step"))


def check_names(scene: Scene) -> None:
    seen: dict[str, str] = {}
    for kind in ("sheets", *scene.machine_tables(), "parts", "probes", "sensors"):
        for name in getattr(scene, kind):
            other = seen.setdefault(name.lower(), f"{kind}.{name}")
            if other != f"{kind}.{name}":
                raise fail(f"the name {name!r} is used twice (also {other})", (kind, name))
    for name, sheet in scene.sheets.items():
        for made, path in sheet.made_names(name):
            other = seen.setdefault(made.lower(), ".".join(map(str, path)))
            if other != ".".join(map(str, path)):
                raise fail(f"the name {made!r}, which is made from it, is taken by {other}; rename one", path)


def _on_sheet(scene: Scene, item: OnSheet, path: tuple[str | int, ...]) -> None:
    known(item.sheet, scene.sheets, "sheet", (*path, "sheet"))
    if item.at is None:
        return
    sheet = scene.sheets[item.sheet]
    for value, lines, axis in zip(item.at, sheet.lines, "xy", strict=True):
        half = lines[-1]
        if abs(value) > half * (1 + 1e-9):
            raise fail(
                f"at: {axis} = {value:g} mm is off the sheet; allowed -{half:g} to {half:g} mm",
                (*path, "at"),
            )
