"""Explanations of the codes of `mdlgen lint` (arity, dangling ...)."""

from __future__ import annotations

TEXT = {
    "angle": (
        "An angle is in the other unit than is due here: sine and cosine take radians, ANGLES of an "
        "orientation degrees."
    ),
    "arity": (
        "A statement, or an instance of a definition, has too many or too few arguments; then all that "
        "follow mean something else."
    ),
    "ascii": (
        "MotionView writes plain ASCII with lines that end in LF. Another character, a byte order mark or "
        "CR LF may not be read."
    ),
    "attachment": (
        "A system is given fewer attachments than its definition has: the defaults count, or what hangs "
        "on the missing one is not known."
    ),
    "block": "A *Begin..., *Define... or *If has no end, or an end stands without a beginning.",
    "bushing": (
        "A bushing has a negative stiffness or damping, none at all, or rotational damping without "
        "rotational stiffness, which often is a slip in the order 3 k, 3 c, 3 kt, 3 ct."
    ),
    "comment": (
        "A comment is within *BeginMDL. No file of MotionView has one there. Before *BeginMDL it is safe."
    ),
    "condition": (
        "The condition of an *If has no value, since something in it is not known; its branch is left out."
    ),
    "contact": "A contact names a graphic that is not on the body of its side.",
    "control": "A control character stands in the text; it may end the reading of the file.",
    "curve": "A curve lacks values, or has not as many of x as of y.",
    "cycle": "A value depends on itself by way of others.",
    "dangling": (
        "A name is used that is defined nowhere in reach. It may be misspelt, or stand in another system."
    ),
    "direction": "An axis is given by two points that lie in one place, or by a vector without length.",
    "duplicate": "One name is defined twice in one scope.",
    "evaluate": "An expression has no value: division by zero, a text where a number is due, and the like.",
    "external": (
        "A name is defined in a file that is not read here, such as the user's model or a "
        "private include, so its value is not known. That is no mistake of the text."
    ),
    "function": "A function in an expression is not known, or takes other values.",
    "include": "An included file is not read, so what it makes is not known here.",
    "inertia": "One principal moment of inertia is larger than the sum of the other two: no body has that.",
    "keyword": "A word such as POINT, VECTOR or EXPR is due at this place.",
    "kind": "A thing of another kind is due: a marker where a body is, and so on.",
    "mass": (
        "A body has no mass, a negative one, or numbers that do not count since it takes its mass from "
        "its graphics."
    ),
    "no-model": "The text has no *BeginMDL, so there is no model to read.",
    "offset": (
        "A roller's cylinder starts at the centre of its roller instead of being centred there: its "
        "offset would be -length/2."
    ),
    "option": "An option is set to a choice that it does not have.",
    "pair": "A pair stands where one of the two is due: add .l or .r.",
    "property": "A thing has no property of that name, or none that is known here.",
    "size": "A graphic has no radius, or a side of no length; a contact with it finds nothing.",
    "standard": "The model has no *StandardInclude(FILE), which makes units, gravity and ground.",
    "syntax": (
        "The text cannot be read here: a quote, a bracket or a brace is not closed, or a statement is due."
    ),
    "template": "A template is not run here, so the text that it writes is not known.",
    "unknown": (
        "A statement is not known here. It may be misspelt, or one that this reader does not act on."
    ),
    "unread": "A *Set of a property that this reader does not act on; its value was not used.",
    "unset": "A thing is defined and never set, so it counts as zero, or has no stiffness or mass.",
    "unused": "A point, value, vector or curve is defined and used nowhere.",
}
