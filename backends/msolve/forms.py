"""Classes of MotionSolve's Python interface that a script uses, each keyword with its kind and confidence.

Those of shapes are in `reader/shapes`.

SEEN: in a script that an Altair program exported, or in one that says it ran there. DOC: in Altair's help,
`help.altair.com/2021/hwsolvers/ms/topics/solvers/ms/` and `help.altair.com/hwsolvers/motionapi/`. A keyword
that is in neither is not here, and so in no script.

A kind is what a value must be: text, number, count (an integer), yes (True or False), point, three, six,
numbers, texts, triples, counts, Part, Marker, Joint, shapes (graphics, one or a list), or its words: A|B.
"""

from __future__ import annotations

from typing import NamedTuple

SEEN, DOC = "SEEN", "DOC"


class Keyword(NamedTuple):
    """Kind of value that a keyword takes, and the confidence of that knowledge."""

    kind: str
    confidence: str


class Form(NamedTuple):
    """One class: its keywords, those that it must have, and its page of the help."""

    keywords: dict[str, Keyword]
    needed: frozenset[str]
    page: str


def form(page: str, seen: str = "", documented: str = "", needed: str = "") -> Form:
    """A Form by the words of its keywords, `name:kind` each."""
    keywords = {
        name: Keyword(kind, confidence)
        for words, confidence in ((seen, SEEN), (documented, DOC))
        for name, _, kind in (word.partition(":") for word in words.split())
    }
    return Form(keywords, frozenset(needed.split()), page)


FORMS: dict[str, Form] = {
    "Model": form("msolve_model.html", "label:text output:text"),
    "Units": form(
        "units_api.htm", "force:text length:text mass:text time:text", needed="force length mass time"
    ),
    "Accgrav": form("msolve.model.forces.html", "igrav:number jgrav:number kgrav:number"),
    "Integrator": form(
        "integrator_api.htm",
        "type:DSTIFF error:number hinit:number hmax:number hmin:number kmax:count maxit:count "
        "dae_index:count dae_constr_tol:number",
    ),
    "Equilibrium": form(
        "equilibrium_api.htm",
        "type:STATIC skip_mkeam:yes error:number maxit:count imbalance:number kinetic_energy_error:number "
        "stability:number",
    ),
    "Output": form("output_api.htm", "reqsave:yes req_comment_only:yes"),
    "H3dOutput": form("h3doutput_api.htm", "save:yes"),
    "Part": form(
        "part_api.htm",
        "label:text ground:yes mass:number ip:six cm:Marker "
        "vx:number vy:number vz:number wx:number wy:number wz:number vm:Marker wm:Marker",
    ),
    "Marker": form(
        "marker_api.htm", "label:text part:Part qp:point zp:point xp:point", "floating:yes", needed="part"
    ),
    "Joint": form(
        "joint_api.htm",
        "label:text type:FIXED|REVOLUTE|TRANSLATIONAL i:Marker j:Marker",
        needed="type i j",
    ),
    "Motion": form(
        "motion_msapi.htm",
        "label:text dtype:VELOCITY|DISPLACEMENT function:text",
        "joint:Joint jtype:ROTATION|TRANSLATION",
        needed="joint jtype dtype function",
    ),
    "Bushing": form(
        "bushing_api.htm",
        "label:text k:three c:three kt:three ct:three",
        "i:Marker j:Marker torque:three force:three",
        needed="i j k c kt ct",
    ),
    "SpringDamper": form(
        "springdamper_api.htm",
        documented="label:text type:TRANSLATION i:Marker j:Marker k:number c:number force:number "
        "length:number",
        needed="type i j",
    ),
    "Spline": form("spline_api.htm", "label:text x:numbers y:numbers linear_extrapolate:yes", needed="x y"),
    "Vforce": form(
        "vforce_api.htm",
        documented="label:text i:Marker jfloat:Marker rm:Marker fx:text fy:text fz:text",
        needed="i jfloat",
    ),
    "Gforce": form(
        "gforce_api.htm",
        documented="label:text i:Marker jfloat:Marker rm:Marker fx:text fy:text fz:text "
        "tx:text ty:text tz:text",
        needed="i jfloat",
    ),
    "Contact": form(
        "contact_api.htm",
        documented="label:text igeom:shapes jgeom:shapes type:POISSON penalty:number "
        "restitution_coefficient:number coulomb_friction:ON|OFF mu_static:number mu_dynamic:number "
        "stiction_transition_velocity:number friction_transition_velocity:number master_surface:I|J",
        needed="igeom jgeom type penalty restitution_coefficient coulomb_friction",
    ),
    "Request": form(
        "request_api.htm",
        "label:text type:EXPRESSION f2:text f3:text f4:text f6:text f7:text f8:text",
        "comment:text",
        needed="type",
    ),
}
ANALYSES = {"STATICS": (), "TRANSIENT": ("end", "dtout")}
"""What `Model.simulate` takes beside `type` and `returnResults` (SEEN)."""
