"""Explanations of the codes of `mdlgen check` (W101 ...) and `mdlgen lint` (arity, dangling ...)."""

from __future__ import annotations

from mdlgen.errors import SpecError, did_you_mean
from mdlgen.explained_text import TEXT as TEXT

SCENE = {
    "W101": (
        "The modulus of a sheet is far from that of paper and board. MPa, Pa and GPa are easily mixed up: "
        "E_md of a banknote is some 3500 MPa = 3.5 GPa. If the sheet is no paper, nothing is wrong."
    ),
    "W102": (
        "Boxes that are more than five times as long as wide resolve bending along their length much more "
        "coarsely than across it. Take more boxes along their length. A sheet that bends one way only needs "
        "one box across, as boxes: [20, 1]; of such a sheet this is not asked."
    ),
    "W103": (
        "A clamped sheet on which nothing acts stays as it is: there is no gravity, load, contact or "
        "speed at the start. Give one, or leave the run out."
    ),
    "W104": (
        "Boxes are flat. A roller whose radius is below half a box's length meets a face, or an edge, "
        "where a sheet would wrap around it; forces and slip are then those of the grid. The boxes rattle, "
        "too, so estimates of errors are taken four times. Use more boxes along the way the sheet runs, or "
        "grading near the roller."
    ),
    "W105": (
        "The preload presses a pressed roller deeper into the sheet than half of its thickness, so "
        "rollers on both sides meet inside it. A contact's depth is (force / stiffness)^(2/3): raise the "
        "contact's stiffness or lower the preload. So deep a nip of a hard and a soft roller also pushes or "
        "holds a sheet by up to 0.2 % of its force, which no estimate covers."
    ),
    "W106": (
        "Friction changes its sign over the smoothing speed, so a sheet in a nip slips by a part of it. "
        "Here that is a noticeable part of the surface speed: the sheet creeps against the roller. A "
        "smaller smoothing takes longer to run."
    ),
    "W107": (
        "The smoothing speed is so small compared with the surface speed that the solver needs many Newton "
        "iterations for each change of sign of friction. Raise it, unless a slower creep than that matters."
    ),
    "W108": (
        "A drive of speed 0 holds its roller still; it does not let it turn freely. Leave `drive` out for "
        "an idler. Where a rule orders another speed the drive waits for it, and there is no lint."
    ),
    "W109": (
        "A sheet that has no contact flies through the machine. Contacts are named one by one, or by a "
        "pattern: {between: [note, 'motor_*'], stiffness: 300 N/mm^1.5, friction: 0.5}."
    ),
    "W110": (
        "A static analysis looks for rest, and a sheet that may move as a rigid body has none, or any. "
        "Clamp an edge, support points, or run a transient analysis."
    ),
    "W111": (
        "A roller, plane, guide or part that touches nothing changes nothing. It may be misspelt in a "
        "contact's `between`."
    ),
    "W112": (
        "A part starts so deep inside a sheet that the contact throws it off at the first step. Positions "
        "are those of centres: a roller's centre is its radius, plus half the sheet's thickness, away "
        "from the sheet's."
    ),
    "W113": (
        "A change of a drive after the end of the run has no effect. Often the ramp or the duration has a "
        "wrong unit."
    ),
    "W114": (
        "The density that follows from mass, size and thickness is not that of a solid sheet. One of the "
        "three probably has a wrong unit; paper has some 0.8 g/cm^3."
    ),
    "W115": (
        "In layout plate, bending in the plane follows from E_md and E_cd as in a beam, so k_tz has no "
        "place. It acts in the layouts edge_to_edge and center_to_center."
    ),
    "W116": (
        "No bending stiffness was given, so it is E s^3/12, that of a solid strip. Paper is layered and "
        "may be half or twice as stiff. Hang a strip, measure its drop, and let `mdlgen calibrate` find "
        "D_md and D_cd."
    ),
    "W117": (
        "A one-way clutch passes torque in one sense only. This drive turns in the other one, so it never "
        "drives. Give `direction` the sign of the speed."
    ),
    "W118": (
        "A pressed roller faces another one near by, and the list of contacts does not name the two. Where "
        "no sheet is between them nothing holds the spring, and the roller moves into the other one. Add a "
        "contact of the two rollers to those with the sheet."
    ),
    "W119": (
        "A roller and a plane, a guide or a mesh are in each other's way, and no contact holds them apart. "
        "A run in which they, apart at its start, come to overlap by more than 0.05 mm ends with both names. "
        "Give the two a contact. A pair that overlaps from the start, as a roller that stands in a hole in a "
        "plate, does not count, nor does a roller that presses on that one from above it and is no wider and "
        "no larger."
    ),
    "W120": (
        "At the start two sheets are nearer to each other than half of the thickness of the thinner one, or "
        "one is in the other, and no contact names the two. Without a contact they do not feel each other. A "
        "run ends, with both names, where they are in each other by more than half of that thickness."
    ),
    "W121": (
        "At the start a sheet is nearer to a roller, a plane or a guide than three quarters of its "
        "thickness, or in it, and no contact names the two. A run ends, with both names, where the middle of "
        "a sheet comes 0.05 mm into such a part. A sheet that is in a part from the start is taken to pass "
        "through a hole, and its run continues. Meshes are not checked."
    ),
    "W122": (
        "A pressed roller begins in balance with the sheet that it touches. That sheet, and those below it, "
        "begin where the scene puts them and sink into each other and into the plate as the run begins. A "
        "constant force F on a contact F = k z^1.5 is stopped at the depth (2.5 F/(n k))^(2/3), 1.84 times "
        "that at rest; n is 1.5 times the number of boxes under the roller. The run ends where "
        "it is three quarters of a thickness. Give a stiffer contact or less preload; a finer step changes "
        "nothing."
    ),
    "W123": (
        "Two driven rollers are at one sheet, and their surfaces move it opposite ways. Probably one turns "
        "the wrong way: rollers on the two sides of a sheet turn in opposite senses. A roller that is slower "
        "than 0.6 of the others' speed counts as a retard roller. surface_speed with direction says which "
        "way the surface moves."
    ),
    "W124": (
        "The driven rollers that touch a sheet as the run begins move it away from all that it could come "
        "to: the parts that its contacts name lie under it or behind it, and none ahead. Probably they turn"
        " the wrong way. A positive speed turns about the axis by the right-hand rule."
    ),
    "W125": (
        "Rolling resistance is a couple against the turning of a roller relative to what it rolls on. A "
        "contact of parts that are no rollers slides and does not roll; what resists there is friction."
    ),
    "W126": (
        "A roller without a drive is turned by friction alone, and here each of its contacts has none: "
        "friction left out is 0. It stands still, pressed or not, while sheets slip past it."
    ),
    "W127": (
        "A parameter is a named value; others follow from it by formulas such as speed/radius. This one "
        "stands in no formula, so changing it changes nothing. It may be misspelt where it was meant."
    ),
    "W128": (
        "Each value of a data set in MotionView text that is a formula here is one there, too, and follows "
        "its parameters. Some values have no place in a data set: lines of clamps and zones, sizes of "
        "dog-ears. They stand in the text as numbers. Nothing is said of a scene that the text refuses."
    ),
    "W129": (
        "Contacts name this roller, and in this run it can touch nothing: within the bounds in which all "
        "moves, with run.margin around them, no box and no other part comes near. Its place, or its axis, "
        "is probably wrong."
    ),
    "W130": (
        "The damping time tau of a material is that of its law stress = E (strain + tau strain rate), and "
        "follows from a loss factor at a frequency: tau = eta/(2 pi f). Paper loses 1 to 10 % at 10 to 100 "
        "Hz, which is 0.01 to 1 ms. ms, s and us are easily mixed up."
    ),
    "W131": (
        "A sheet with a damping time tau comes to its shape under a load as 1 - exp(-t/tau). In a run that "
        "is shorter it hardly bends or stretches, and looks much stiffer than it is."
    ),
    "W132": (
        "The damping ratio of a mode with angular frequency omega is omega tau/2. Above 1 the lowest bending "
        "mode does not swing, it creeps back. For soft or damped plastics that may be right; for paper the "
        "unit of the time is probably wrong."
    ),
    "W133": (
        "A sheet that lies on a plane sinks into it until k z^1.5 of its boxes carries its weight. Here "
        "that is deeper than the sheet is thick, so it falls through. Give a stiffer contact: k in N/mm^1.5"
        " is for one box, and 100 is usual for paper."
    ),
    "W134": (
        "The run is long, and one value makes it at least four times as long as with a usual one: a step, a"
        " time between outputs or a tolerance that is very small, very many boxes, air between sheets, or a "
        "duration of more than a second. Often its unit is wrong. The time of a run is estimated from boxes, "
        "pairs and steps, mostly within a factor of 2."
    ),
    "W135": (
        "A plane stands across the plane of a sheet, as a stop does, and is more than twice as tall as wide, "
        "and the sheet more than twice as wide. Probably its two lengths are swapped. The first length of "
        "size lies along the projection of global x on the face, or of global y where the normal is near "
        "x; along says which side is meant."
    ),
    "W136": (
        "Gases have viscosities of 8 to 50 uPa s, air at 20 deg C 18.2. A film with one of another size "
        "holds sheets apart, or lets them fall, as no air does. Probably the prefix of its unit is wrong or "
        "left out."
    ),
    "W137": (
        "The air between two sheets pushes them while its gap changes. A static analysis looks for a state "
        "in which nothing moves, so that its air does nothing."
    ),
    "W138": (
        "Friction without `sticking` rises from 0 at rest to mu N at the stiction velocity v_s (Eq. 12; the "
        "smoothing where it is left out). So a sheet on a slope creeps at the speed v at which friction "
        "carries its weight: tan(slope)/mu = x (3 - x^2)/2 with x = v/v_s. The lint comes where v times the "
        "duration is more than run.tolerance times a tenth of the sheet's length, and nothing but this plane "
        "and other sheets is in reach. friction.sticking holds it; a lower smoothing makes it slower."
    ),
    "W139": (
        "Friction without `sticking` is 0 at rest, so that a stopped nip does not hold a sheet: it creeps "
        "under its weight, at 0.35 of the smoothing speed where that is half of what friction can hold. The "
        "load is not known before the run; the line has the way for half. It comes where the drive stands "
        "for more than a tenth of the run, by its speed or its profile, a sheet may come to the part, and "
        "that way is more than run.tolerance times the way of the fastest driven surface that the sheet has "
        "a contact with, or times a tenth of the sheet's length where that is more. Where a rule moves the "
        "drive the time is that without the rule. After the run an event `creep` says what was held, and how "
        "far it crept. friction.sticking holds it."
    ),
    "W140": (
        "Friction that scatters has a correlation length, over which it changes. A box has the mean over its "
        "face. One that is larger than that length has hardly any scatter: a sheet of such boxes behaves as "
        "if its friction were the same everywhere, but for what the whole sheet has more or less than the "
        "mean. Boxes of half the length have nearly all of it."
    ),
    "W141": (
        "Poisson's effect couples joints along x with joints along y. A sheet of one row of boxes has joints "
        "along one of them only, and bends and stretches as a strip does, whatever poisson is."
    ),
    "W145": (
        "A sheet bends between its boxes alone. A bend of the curvature kappa turns it by kappa L from one "
        "box of the length L to the next. From 0.5 rad on the chain of boxes is more than 1 % shorter than "
        "the arc. `grading` makes boxes finer where the sheet is bent most."
    ),
    "W146": (
        "A sheet that follows a roller bends to the roller's radius and half of its own thickness. Where "
        "that is below the inverse of the yield curvature, it keeps the curvature (1 - h)(kappa - kappa_y) "
        "as it leaves, with the hardening h."
    ),
    "W147": (
        "Young's modulus of a cover follows from its hardness by Gent's relation (1958), which holds from 20 "
        "to 80 degrees of Shore A. Below, the foot of the durometer touches the rubber; above, its needle "
        "hardly moves. Another published relation, Ruess' lg E = 0.0235 S - 0.6403 from 30 to 60 degrees, "
        "has 2 % more at 30, 18 % more at 40 and 63 % more at 60. Give a measured `modulus` where the nip "
        "has to be right."
    ),
    "W148": (
        "The nip of a cover is computed with Hooke's law for small strains. Rubber that is pressed together "
        "by 20 % is 27 % stiffer than that (neo-Hookean law: stress G (1/l^2 - l) at a length l, in place of "
        "3 G (1 - l)). So the nip is narrower and the indentation less than stated."
    ),
    "W149": (
        "The formulas take the surfaces in a nip for parabolas, x^2/(2R). At a half-width of 0.3 R that is "
        "2.3 % off the round, and the pressure no longer acts along one direction."
    ),
    "W150": (
        "A soft cover lets the hard roller in by more than the sheet is thick. Then the contact of the two "
        "rollers with each other acts as well as that of each with the sheet, and the spring carries both. A "
        "nip adds that to its preload, so that the sheet has the force of the nip; a press of your own does "
        "not. In reality the sheet alone is between them: torque and friction of the rollers on each other "
        "are too much here."
    ),
    "W165": (
        "A rule acts when its condition comes true. This one cannot: the machine never comes to a state "
        "named in its `in`, its sensor never sees a sheet, or the time is beyond the run."
    ),
    "W166": (
        "Two rules with one condition and one delay tell the same part two things. The rules act in the "
        "order of the list, so the later one is what the part does."
    ),
    "W167": (
        "A sheet is followed as far as its speed and the drives can take it in the run, with a margin. It "
        "does not come to this sensor. A beam has to cross the middle surface; a point or a line sees as "
        "far as its `reach`, 5 mm where that is left out."
    ),
    "W160": (
        "A motor has less torque at rest than its bearing, or friction in its nips, can take from it. By the "
        "bearing alone it never turns. By the nips it stalls where a sheet is held, and the sheet does not "
        "slip. Friction of a nip is its static coefficient times the preload of its spring times the radius. "
        "Give a stronger motor, or a gear, unless that is meant as a protection."
    ),
    "W161": (
        "A torque limiter slips where its torque is less than friction of the nip can take. Above it the "
        "sheet slips on the roller, and the limiter never does: a retard roller then holds a sheet back by "
        "friction, which changes with the force of the nip. Give less torque, or press harder."
    ),
    "W162": (
        "A stepper that is at rest follows steps at once up to the speed at which the kinetic energy against "
        "its field is what takes it over the top of its torque: J v^2/2 = 2 T/p, p periods of the torque per "
        "radian. Faster steps need a ramp."
    ),
    "W163": (
        "A shaft couples rollers, so that one that is held loads the others. With one roller alone it is the "
        "axle of that. Name the others below `rollers`, or give the roller itself drive and bearing."
    ),
    "W164": (
        "A motor has no torque at its no-load speed. One that aims at that speed, or beyond it, never gets "
        "there under load; a stepper falls out of step. Aim lower, or change motor or gear."
    ),
    "W173": (
        "A part that turns about a pivot, or slides, goes through another part of the machine that it has no "
        "contact with. A run does not stop it there. Checked are 25 places of its path, between the least "
        "and the greatest that its profile or its positions have. A part that it overlaps where it is given"
        " has a hole that is not modelled, and is not checked."
    ),
    "W174": (
        "`positions` names places, so that a profile and rules can name them. One that neither of them names "
        "only widens the checked range of the motion."
    ),
    "W175": (
        "The profile of a part continues after the end of the run, so the part does not come to where its "
        "last corner says."
    ),
    "W176": (
        "A part that is free to turn, or to slide, begins at rest at its place 0. Its spring and its weight "
        "do not balance there, and no stop holds it, so it moves as the run begins. That may be meant."
    ),
    "W177": (
        "A run ends where a free part is further past its stop than a tenth of the way between both stops, "
        "from which its contacts were chosen. Here its spring and its weight alone push it so far."
    ),
    "W178": (
        "Two sheets in one place end a run. The gap of two sheets of a stream is its time between them times "
        "their speed, less their length; it has to be above zero, and more with jitter and skew. If the "
        "machine slows the first one down, the gap is smaller."
    ),
    "W179": (
        "A sheet that has not come yet is not there: nothing meets it, it costs nothing, and nothing is "
        "judged of it. Where one never comes, the count or the time between sheets is often too large."
    ),
    "W180": (
        "A sheet has left once all of it is beyond its plane, on the other side of it than where it came in. "
        "Its boxes are watched in bounds that follow from all that may move them in the run, and the plane "
        "is outside of these. A sheet that never leaves costs time to the end of the run."
    ),
    "W186": (
        "A guide is touched on one side, left or right of its line as seen from `from` to `to`, or on both. "
        "The sheets that this one has a contact with pass on the other side, or come from behind, in each of "
        "its places: they go through it, or are caught by its back."
    ),
    "W187": (
        "A part that turns about a pivot, or slides, goes through a sheet that lies in its way as the run "
        "begins. Without a contact between the two a run does not see that. Looked at are 25 places of the "
        "part, between the least and the greatest that its profile or its positions have."
    ),
    "W188": (
        "A torque limiter turns its roller from a shaft with up to its torque. The friction of the roller's "
        "own bearing is above that, or its drag at the speed of the shaft is: with an empty nip the roller "
        "stands, or runs slower than its shaft and heats the limiter."
    ),
    "W189": (
        "A rule sends the machine to a state that no `in` names, and each rule has an `in`: from then on no "
        "rule acts. That may be the end that is meant, or the state is misspelt."
    ),
    "W183": "A load, or gravity, has a factor over time that is 0 from the start of the run to its end.",
    "W184": (
        "A factor over time has corners after the end of the run. Its values there are not simulated. A "
        "static analysis has the factor of the first corner."
    ),
    "W185": (
        "A pressed roller begins further from where it touches than its spring or its contact can take: "
        "drawn back by the whole length of the spring, or further ahead than half of its radius. A local run "
        "does not need the length of a spring, but MotionView does."
    ),
}


def explain(code: str) -> str:
    """The meaning of a code and its remedy. Raises SpecError for an unknown code."""
    known = {**SCENE, **TEXT}
    wanted = code.upper() if code.upper() in known else code.lower()
    if wanted not in known:
        close = did_you_mean(wanted, known)
        raise SpecError(f"there is no code {code[:40]!r}{close}; `mdlgen explain` lists them")
    return known[wanted]
