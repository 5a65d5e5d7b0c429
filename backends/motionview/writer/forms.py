"""Which statements of a text nobody has seen a real MotionView read, so that a user knows where to look."""

from __future__ import annotations

from mdlgen.backends.motionview.writer.rows import SceneView, SystemView

_BUSH = "SetOrientation of a Bush by two axes (seen by one axis, and by two for pairs of bushings)"


def unverified(scene: SceneView, whole: bool = True) -> list[str]:
    """One line for each form in this text that is documented only, or concluded from a similar one.

    `whole`: of a model, with gravity and run settings.
    """
    curved = any(s.curves for s in scene.sheets)
    joined = [s for s in scene.sheets if s.joints]
    aligned = ", ".join(s.name for s in scene.sheets if not s.turned)
    rows = (
        (
            any(not g.straight for g in scene.guides) or any(r.rim for r in scene.rollers),
            "several graphics of one body in a Contact (documented), and a BOX turned by VECTOR and POINT "
            "(documented; seen by two vectors)",
        ),
        (
            bool(scene.meshes),
            "CADGraphic (documented; that it takes STL and OBJ files is not, nor the empty list of "
            "components : where it does not, turn the file to .g or .h3d with mvg and write FILE)",
        ),
        (
            whole,
            "ds_gravity and ds_units in model.sys_misc (documented together, not seen in a file; another "
            "page has DS_Gravity and DS_Units at the model)",
        ),
        (
            whole,
            "in the run template {format, %.15g}, without which Templex prints six digits, and "
            f"Param_{'Static' if scene.static else 'Transient'} (documented as a command; seen in the model)",
        ),
        (
            whole,
            "DS_MotionSolve_Simopts set at the model (seen inside a system) : should the run not end at "
            "real_end, switch the values of the Run panel off there",
        ),
        (True, "SetOrientation of a marker by DXDYDZ with formulas (seen with numbers only)"),
        (any(s.turned for s in joined) or any(r.arm and r.arm.sprung for r in scene.rollers), _BUSH),
        (
            any(not s.turned for s in joined),
            f"inside an if, so only where an angle of {aligned} is changed from 0 : {_BUSH}",
        ),
        (
            bool(aligned),
            "if with a value of a data set (seen with options) : should a new angle move the points and "
            "leave the axes behind, save and load the text again",
        ),
        (any(r.driven for r in scene.rollers), "SetMotion VEL, EXPR (documented; seen with DISP)"),
        (
            any(r.corners > 3 for r in scene.rollers),
            "SetMotion on one line of more than 528 characters, the longest seen (a drive of many corners)",
        ),
        (
            any(p.pressed for p in (*scene.rollers, *scene.planes)),
            "CoilSpring and SetCoilSpring (documented; seen as pairs)",
        ),
        (
            bool(scene.supports) or any(r.arm and r.arm.sprung for r in scene.rollers),
            "Bush with zero stiffness in some directions (a form of the documented one)",
        ),
        (
            any(s.moving for s in scene.sheets),
            "Global_Frame as the marker of initial velocities in Body (documented, not seen)",
        ),
        (
            any(s.bend is not None and s.bend.flat for s in scene.sheets)
            or any(r.arm and r.arm.sprung for r in scene.rollers),
            "preload torques of SetBush (documented; that they act on the first body is concluded)",
        ),
        (
            bool(scene.loads),
            "ActionOnlyForce with TRANS, and SetForce with LIN three times (documented; seen with ROT, and "
            "with two LIN and an EXPR) : that components are along the reference marker",
        ),
        (bool(scene.pairs), "Contact (documented, not seen in a file)"),
        (
            bool(scene.laws),
            "the Force_Contact commands of the run template (documented by keyword) : idstring of a contact, "
            "as of a motion or a force in a file; should the solver's log refuse them, write the text with "
            "--set-contact, or run the companion script and delete them",
        ),
        (
            bool(scene.pairs) and scene.set_contact,
            "SetContact (argument order documented; the word for compute_force_at is not known and left out)",
        ),
        (
            curved,
            "CRV in SetBush (documented, not seen) : its independent variable, here the displacement of "
            "marker i against j along j, and that the curve pulls back, as k times it does",
        ),
        (curved, "SetCurve with formulas (seen with numbers only)"),
        (any(s.surface for s in scene.sheets), "DeformableSurface (documented, not seen in a file)"),
    )
    return [line for needed, line in rows if needed]


def unverified_system(system: SystemView) -> list[str]:
    """The same for a text that is a system definition."""
    rows = (
        (True, "a file with definitions alone (concluded from Include, which reads statements anywhere)"),
        (True, "these notes behind // above the first statement (concluded; delete them if it complains)"),
        (True, "definitions of data sets beside that of the system (seen in models, not in such a file)"),
        (
            bool(system.attachments),
            "Attachment of type Graphic, and its use in Contact (the type is documented, not seen in a file)",
        ),
    )
    return [line for needed, line in rows if needed] + unverified(system.scene, whole=False)
