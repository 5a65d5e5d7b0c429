"""Forms of a text that no file shows which MotionView saved: those that only a like one speaks for, so that
a user knows where to look, and those of Altair's help, each with its page.

The manual's page is made of the same rows (`docs/_generate/forms.py`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from mdlgen.backends.motionview.writer.moving import StopsView
from mdlgen.backends.motionview.writer.scene_rows import SceneView, SystemView

MOTIONVIEW = "2021.help.altair.com/2021/hwdesktop/hwd/topics/reference/mv/"
MOTIONSOLVE = "2021.help.altair.com/2021/hwsolvers/ms/topics/solvers/ms/"
_LONG = 3  # corners of a speed with which its formula stays within the longest line that was seen


class Unverified(NamedTuple):
    """A form that neither a file nor a page shows."""

    form: str
    why: str  # what speaks for it, and what is not known
    look: str  # where it shows in MotionView, and what to do
    used: Callable[[SceneView], bool]


class Documented(NamedTuple):
    """A form of Altair's help that no file shows."""

    form: str
    pages: tuple[str, ...]  # of MOTIONVIEW, or with the address of another version
    used: Callable[[SceneView], bool]


def _of_model(scene: SceneView) -> bool:
    return bool(scene.run)


def _joined(scene: SceneView) -> bool:
    return any(s.joints for s in scene.sheets) or _sprung(scene)


def _sprung(scene: SceneView) -> bool:
    moved = any(part.moving and part.moving.sprung for part in scene.moved)
    return moved or any(r.arm and r.arm.sprung for r in scene.rollers)


def _stopped(scene: SceneView) -> list[StopsView]:
    own = [part.stops for part in (*scene.rollers, *scene.planes) if part.stops]
    return own + [part.moving.stops for part in scene.moved if part.moving and part.moving.stops]


def _pressed(scene: SceneView) -> bool:
    return any(part.pressed for part in (*scene.rollers, *scene.planes))


def _curved(scene: SceneView) -> bool:
    return any(s.curves for s in scene.sheets)


def _pushed(scene: SceneView) -> bool:
    return any(s.bend is not None and s.bend.flat for s in scene.sheets) or _sprung(scene)


def _faceted(scene: SceneView) -> bool:
    return any(not g.straight for g in scene.guides) or any(r.rim for r in scene.rollers)


UNVERIFIED = (
    Unverified(
        "`{con_x.idstring}` in `Force_Contact` commands of a template, and with `--forces` in outputs",
        "each attribute is documented (`xml-format_9.htm`), and so is `idstring` of bodies (`body_r.htm`); "
        "commands that change a motion or a force by it are seen, one that changes a contact is not",
        "the numbers of a contact in the command section of the exported deck, and the solver's log; else "
        "`--set-contact`, or the script",
        lambda scene: bool(scene.laws or scene.forces),
    ),
    Unverified(
        "`CADGraphic` with STL and OBJ files and an empty list of components",
        "that contacts take meshes of both files is documented (`best_practices_for_modeling_3d_contacts_ms"
        ".htm`, 2021.1), that this statement reads them is not",
        "the picture of a mesh; else turn the file to .g or .h3d with `mvg` and write `FILE`",
        lambda scene: bool(scene.meshes),
    ),
    Unverified(
        "`CRV` in `*SetBush`",
        "documented (`setbush_single_bushing_r.htm`) but for two things: that the variable, which is the "
        "displacement of marker i against j along j, has this sign, and that the curve pulls back as k times "
        "it does",
        "a bushing's Properties panel, in the text of `snatch`; export the deck",
        _curved,
    ),
    Unverified(
        "a line of more than 528 characters, the longest that was seen",
        "speeds and motions with many corners, clutches, motors, limiters, stops, and loads over time; no "
        "page has a limit",
        "the end of the line in the panel of a motion or a force",
        lambda scene: (
            any(r.corners > _LONG or r.free_sense or r.axle for r in scene.rollers)
            or any(load.changes for load in scene.loads)
            or any(part.moving and part.moving.corners > _LONG for part in scene.moved)
            or bool(_stopped(scene))
        ),
    ),
    Unverified(
        "`*SetContact` of `POISSON`",
        "only with `--set-contact`: its page (`setcontact_rigidtorigidcontact_r.htm`) has the order, and no "
        "word for where forces are computed, which is left out; its order for `IMPACT` is not that of its "
        "own example",
        "a contact's Normal Force and Friction tabs",
        lambda scene: bool(scene.pairs) and scene.set_contact,
    ),
)
OF_SYSTEMS = Unverified(
    "notes behind `//` above a definition, and Add System from such a file",
    "only with `--only sheets`; files of MDL statements are documented for `*Include` (`include_r.htm`), one "
    "with a definition alone is seen in `*DefinitionInclude`",
    "should it complain, delete the notes, and write `*Include` and `*System` into the model",
    lambda scene: False,
)
OF_SCRIPTS = Unverified(
    "attributes in place of `getChild(name=..)` in the companion script",
    "only in versions without it: it is in a public script for 2026.1; that children are attributes is "
    "concluded from `gravity`",
    "what the script prints at its end",
    lambda scene: False,
)

DOCUMENTED = (
    Documented(
        "`*SetOrientation` of a single `*Bush` by two axes (seen by one, and by two for pairs)",
        (
            "2022.help.altair.com/2022.1/hwdesktop/hwd/topics/reference/mv/setorientation_marker_dual_axes_orientation_r.htm",
        ),
        _joined,
    ),
    Documented(
        "`*SetMotion( .., VEL, EXPR, .. )` (seen with `DISP`)",
        ("setmotion_single_motion_r.htm",),
        lambda scene: any(r.driven and not (r.free_sense or r.axle) for r in scene.rollers),
    ),
    Documented(
        "single `*CoilSpring`, `*SetCoilSpring` (seen as pairs)",
        ("coilspring_r.htm", "setcoilspring_single_coil_spring_r.htm"),
        _pressed,
    ),
    Documented(
        "`*Bush` with no stiffness in some directions: all that is not negative is allowed",
        (f"{MOTIONSOLVE}xml-format_56.htm",),
        lambda scene: bool(scene.supports) or _sprung(scene),
    ),
    Documented(
        "preloads of `*SetBush`, which act at marker i, on the first body",
        ("setbush_single_bushing_r.htm", "bush_r.htm", f"{MOTIONSOLVE}xml-format_8.htm"),
        _pushed,
    ),
    Documented(
        "`*SetCurve` with formulas (seen with numbers): any data may be one",
        (
            "setcurve_cartesian_2d_r.htm",
            "2021.help.altair.com/2021.2/hwdesktop/mv/topics/motionview/motionview_overview_r.htm",
        ),
        _curved,
    ),
    Documented(
        "`*Contact( .., POISSON, .. )`, of several graphics too; in 2025 without words for flipped normals",
        ("contact_r.htm", "2025.help.altair.com/2025/hwdesktop/hwd/topics/reference/mv/contact_r.htm"),
        lambda scene: bool(scene.pairs),
    ),
    Documented(
        "`master_surface` of a `Force_Contact` command; side I is the first body",
        (
            f"{MOTIONSOLVE}xml-format_9.htm",
            "2024.help.altair.com/2024.1/hwdesktop/hwx/topics/motionview/contacts_edit_r.htm",
        ),
        lambda scene: any(law.master for law in scene.laws),
    ),
    Documented(
        "with `--forces` sums of `CONTACT` in `*Output( .., EXPR, .. )`",
        (
            f"{MOTIONSOLVE}contact.htm",
            "help.altair.com/hwdesktop/hwx/topics/motionview/template_expressions_r.htm",
        ),
        lambda scene: bool(scene.forces),
    ),
    Documented(
        "a `BOX` turned by `VECTOR` and `POINT` (seen by two vectors)", ("graphic_box_r.htm",), _faceted
    ),
    Documented(
        "`*DeformableSurface`", ("deformablesurface_r.htm",), lambda s: any(v.surface for v in s.sheets)
    ),
    Documented(
        "velocity markers of `*Body`",
        ("body_r.htm",),
        lambda scene: any(s.moving for s in scene.sheets) or any(r.spins for r in scene.rollers),
    ),
    Documented(
        "`*ActionOnlyForce( .., TRANS, .. )`, `*SetForce` with `LIN` three times (seen with `ROT`, and with "
        "two `LIN` and an `EXPR`); components are along the reference marker",
        ("actiononlyforce_r.htm", "setforce_translational_r.htm"),
        lambda scene: bool(scene.loads) or any(not own.turns for own in _stopped(scene)),
    ),
    Documented(
        "`ds_gravity` and `ds_units` in `*BeginContext( model.sys_misc )`; another page has `DS_Gravity` at "
        "the model",
        (
            "setoption_r.htm",
            "2021.help.altair.com/2021/hwdesktop/mv/topics/motionview/systems_background_c.htm",
        ),
        _of_model,
    ),
    Documented(
        "`{format, %.15g}` in a template, without which numbers have six digits",
        ("2021.help.altair.com/2021/hwdesktop/hwd/topics/reference/templex/format.htm",),
        _of_model,
    ),
    Documented(
        "`Param_Transient`, `Param_Static` as commands (seen in the model)",
        (
            "2022.help.altair.com/2022.1/hwsolvers/ms/topics/solvers/ms/xml-format_24.htm",
            "2022.help.altair.com/2022.1/hwsolvers/ms/topics/solvers/ms/xml-format_23.htm",
        ),
        _of_model,
    ),
)
OF_ATTACHMENTS = Documented(
    "`*Attachment` of type Graphic; only with `--only sheets`",
    ("2022.help.altair.com/2022/hwdesktop/hwd/topics/reference/mv/attachment_r.htm",),
    lambda scene: False,
)


def plain(text: str) -> str:
    """Without what is for the manual: nothing before a model may look like a statement."""
    return text.replace("`", "").replace("*", "").replace("; ", ", ")


def unverified(scene: SceneView) -> list[str]:
    """Lines on the forms in this text that no file shows: first those that no page shows either."""
    return _lines(
        [row for row in UNVERIFIED if row.used(scene)], [row for row in DOCUMENTED if row.used(scene)]
    )


def unverified_system(system: SystemView) -> list[str]:
    """The same for a text that is a system definition."""
    scene = system.scene
    rows = [OF_SYSTEMS, *(row for row in UNVERIFIED if row.used(scene))]
    pages = [row for row in DOCUMENTED if row.used(scene) and row.used is not _of_model]
    return _lines(rows, [*pages, OF_ATTACHMENTS] if system.attachments else pages)


def _lines(rows: list[Unverified], pages: list[Documented]) -> list[str]:
    lines = ["", "Not yet read by a real MotionView; look at these first if it complains :"]
    lines += [f"  {plain(row.form)} : {plain(row.look)}" for row in rows]
    if pages:
        lines += ["In Altair's help, in no file that was seen (pages : manual, What is unverified) :"]
        lines += [f"  {plain(row.form)}" for row in pages]
    return lines
