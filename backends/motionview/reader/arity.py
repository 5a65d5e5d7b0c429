"""How many arguments a statement takes: as the reference documents it, and as real files were counted.

Empty arguments count. `4-6` is a range, `3+` is three or more, `5 8` is either.
"""

from __future__ import annotations

from functools import lru_cache

from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things.drives import flip_step

_TABLE = """
BeginMDL 2-3            EndMDL 0              StandardInclude 1-3    Include 1
DefinitionInclude 1-2   LoadPreferenceFile 1  SetCurrentSolverMode 1
BeginContext 1          EndContext 0          EndDefine 0            SetSystem 1
if 1                    elseif 1              else 0                 endif 0

Point 2                 PointPair 2           SetPoint 4 5 8
Vector 2                VectorPair 2          SetVector 4 5 8
Marker 4                MarkerPair 4          SetOrientation 5+
Body 2-7                BodyPair 2-7          SetBody 8-9            SetBodyInertia 5-9
SetBodyIC 7-8           SetBodyICFlag 7-8     Set 2

DefineDataSet 1+        DataSet 3+            Real 3                 Integer 3
String 3                Boolean 3             Filename 3             Option 4+
SetReal 2               SetInteger 2          SetString 2            SetBoolean 2
SetOption 2             SetVal 2              SetFileName 2          Table 3-4
DefineRecord 1          DefineTableForm 1+    DefineForm 1+          Form 3+
SetRowsCols 2           MergeCells 4          ColumnLabel 3          ColumnWidth 2
SetCell 3-6             SetNote 2             Report 3+              DefineReport 1+

Bush 5                  BushPair 5            SetBush 2+
CoilSpring 6            CoilSpringPair 6      SetCoilSpring 2+
Curve 7                 SetCurve 4+           Spline3D 3+
ActionReactionForce 7+  ActionReactionForcePair 7+                   SetForce 2+
ActionOnlyForce 6+      ActionOnlyForcePair 6+
PolyBeam 4+             SetPolyBeamProps 3+   PolyBeamPair 4+

Graphic 4+              GraphicPair 4+        DefineGraphic 1+       SetGraphicAttributes 2
SetColorMaterialReference 2

RevJoint 7-8            RevJointPair 7-8      TransJoint 7-8         TransJointPair 7-8
CylJoint 7-8            CylJointPair 7-8      FixedJoint 5-6         FixedJointPair 5-6
BallJoint 5-6           BallJointPair 5-6     UJoint 11-12           UJointPair 11-12
CVJoint 9               CVJointPair 9         InlineJoint 8          InlineJointPair 8
PerpAxesJoint 9         PerpAxesJointPair 9   ParallelAxesJoint 7-9  PlanarJoint 7-8
Motion 3-5              MotionPair 3-5        SetMotion 4+
Coupler 5+              SetCoupler 2+

Contact 10+             SetContact 3-11       DeformableSurface 9+   DeformableCurve 3+
PointToDeformableSurfaceContact 7

Output 4+               SolverVariable 2      SolverVariablePair 2   SetSolverVariable 3-7
SolverArray 3           SetSolverArray 2+     SolverString 2         SetSolverString 2-3
SetEntityId 2           SetLocalUserDLLFlag 2 SetLocalUserFunction 2-4

DefineSystem 1+         System 3+             Attachment 3-6         AttachmentCandidate 3
SetAttachmentCandidateTag 2                   DefineAnalysis 1+      Analysis 3+
SetActiveAnalysis 1     DefineTemplate 1+     Template 4+
"""
# Names that are often mistaken for a statement, and the statement that was meant.
_MEANT = {
    "bushing": "Bush",
    "setbushing": "SetBush",
    "setmarker": "SetOrientation",
    "setbodycm": "Body, whose third argument is the centre of mass",
    "spring": "CoilSpring",
    "springdamper": "CoilSpring",
    "setspringdamper": "SetCoilSpring",
    "joint": "RevJoint, TransJoint and so on",
    "sphericaljoint": "BallJoint",
    "box": "Graphic with BOX",
    "for": "statements written out one by one; MDL has no loop",
}
# Arguments of a Graphic by its shape; those of a compound graphic are its own.
_GRAPHICS = {"CYLINDER": (13,), "SPHERE": (7,), "FILE": (17,), "TIRE": (8,), "CADGRAPHIC": (19,)}
_BOXES = {"CENTER": (15,), "CORNER": (15,), "FACE": (13,)}


def _ranges() -> dict[str, tuple[str, list[tuple[int, float]]]]:
    found: dict[str, tuple[str, list[tuple[int, float]]]] = {}
    name = ""
    for word in _TABLE.split():
        if not word[0].isdigit():
            name = word
            found[name.lower()] = (name, [])
            continue
        low, dash, high = word.rstrip("+").partition("-")
        top = float("inf") if word.endswith("+") else float(high if dash else low)
        found[name.lower()][1].append((int(low), top))
    return found


RANGES = _ranges()


def known(statement: Statement) -> bool:
    """True if the statement is documented or was seen in a real file."""
    return statement.key in RANGES


def meant(statement: Statement) -> str:
    """Hint at the statement that was probably meant by an unknown one."""
    hint = _MEANT.get(statement.key)
    return f"; meant is *{hint}" if hint else ""


def complaint(statement: Statement) -> str:
    """Reason why the number of arguments is wrong, or an empty text."""
    count = len(statement.args)
    name, ranges = RANGES[statement.key]
    for low, high in ranges:
        if low <= count <= high:
            break
    else:
        return f"*{name} takes {' or '.join(map(_shown, ranges))} arguments, not {count}"
    special = _SPECIAL.get(statement.key)
    return special(statement, count) if special else ""


def _shown(range_: tuple[int, float]) -> str:
    low, high = range_
    if high == float("inf"):
        return f"{low} or more"
    return str(low) if high == low else f"{low} to {int(high)}"


def _graphic(statement: Statement, count: int) -> str:
    shape = statement.arg(2).upper()
    counts = _BOXES.get(statement.arg(4).upper()) if shape == "BOX" else _GRAPHICS.get(shape)
    if shape == "BOX" and counts is None:
        return f"*{statement.name} BOX needs CENTER, CORNER or FACE, not {statement.arg(4) or 'nothing'}"
    if counts and count not in counts:
        return f"*{statement.name} {shape} takes {' or '.join(map(str, counts))} arguments, not {count}"
    return ""


def _option(statement: Statement, count: int) -> str:
    choices = statement.arg(2)
    if not choices.isdigit():
        return ""
    n = int(choices)
    fits = (3 + n, 4 + n, 4 + 2 * n, 4 + 3 * n)
    if count in fits:
        return ""
    return f"*Option with {n} choices takes {' or '.join(map(str, sorted(set(fits))))} arguments, not {count}"


def _contact(statement: Statement, count: int) -> str:
    at = 4
    for side in (1, 2):
        word, n = statement.arg(at).upper(), statement.arg(at + 2)
        if word != "BODY" or not n.isdigit():
            return f"*Contact: BODY, body, number of graphics is due for body {side}, not {word or 'nothing'}"
        at += 3 + flip_step(statement.args, at) * int(n)
    return "" if at == count else f"*Contact with these graphics takes {at} arguments, not {count}"


def _output(statement: Statement, count: int) -> str:
    if statement.arg(2).upper() == "EXPR" and count != 9:
        return f"*Output EXPR takes 9 arguments (six expressions), not {count}"
    return ""


def _orientation(statement: Statement, count: int) -> str:
    return _orienting(statement.args[1:])


@lru_cache(64)  # a sheet turns all its boxes alike
def _orienting(given: tuple[str, ...]) -> str:
    args = ["", *[a.upper() for a in given]]
    count = len(args)
    at = 1
    sides = 1
    if args[1] in ("LEFT", "RIGHT"):
        at = 2
    elif not args[1]:
        at, sides = 2, 2
    for _ in range(sides):
        mode = args[at] if at < count else ""
        directions = {"TWOAXES": 2, "ONEAXIS": 1}.get(mode)
        if directions is None:
            if mode != "ANGLES":
                return f"*SetOrientation: TWOAXES, ONEAXIS or ANGLES is due, not {mode or 'nothing'}"
            at += 5
            continue
        at += 2
        for _ in range(directions):
            at += 4 if at < count and args[at] == "DXDYDZ" else 2
    return "" if at == count else f"*SetOrientation of this form takes {at} arguments, not {count}"


_LAWS = {"LIN": 2, "EXPR": 2, "CRV": 4, "SPL3D": 5}


def _laws(name: str, laws: int, numbers: int):
    @lru_cache(64)  # and its bushings have the same laws
    def of(given: tuple[str, ...]) -> str:
        args = ["", *[a.upper() for a in given]]
        count = len(args)
        at = 2 if args[1] in ("LEFT", "RIGHT") else 1
        for k in range(laws):
            word = args[at] if at < count else ""
            if word not in _LAWS:
                due = f"LIN, CRV, SPL3D or EXPR is due as number {k + 1} of {laws}"
                return f"*{name}: {due}, not {word or 'nothing'}"
            at += _LAWS[word]
        at += numbers
        return "" if at == count else f"*{name} of this form takes {at} arguments, not {count}"

    return lambda statement, _: of(statement.args[1:])


_SPECIAL = {
    "graphic": _graphic,
    "graphicpair": _graphic,
    "option": _option,
    "contact": _contact,
    "output": _output,
    "setorientation": _orientation,
    "setbush": _laws("SetBush", 12, 6),
    "setcoilspring": _laws("SetCoilSpring", 2, 2),
}
