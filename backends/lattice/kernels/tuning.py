"""Every number of the solver that is not physics, with its unit, its meaning and its origin.

An origin is one of three. Derived: it follows, and the comment says from what. Measured: what is named shows
it, or showed it at an earlier state. Convention: a choice; what it is chosen between is said where that is
known. Numbers without a unit are parts or counts. `tests/solvers/test_tuning.py` sees to it that no other
file has any.
"""

from __future__ import annotations

# -- The size of a step
# [ms] Convention: longest first step at a tolerance of 1e-3; it goes with the root of the tolerance, since
# the error of the midpoint rule goes with the square of the step.
FIRST_STEP = 0.2

# Convention: how often a search halves the step to meet the tolerance, of flexible sheets and of rigid
# blocks, which take little time.
MOST_REFINED, MOST_REFINED_RIGID = 5, 8

# Convention: how often a step may be halved, down to a 16,000th.
HALVINGS_MOST = 14

# Convention: how often at most for accuracy alone. Not more than HALVINGS_MOST, which counts the rest.
FINEST = 12

# Convention: a step is taken again where it misses its guess, or makes energy, so many times as much as it
# may; below, the next one is halved.
TAKEN_AGAIN = 4.0

# Convention: where the step of rigid blocks is chosen, velocities may miss their guess by this part of the
# speed at a tolerance of 1e-3; else the step is halved. Sheets flutter, and miss it always.
MAY_MISS = 1e-3

# Convention: energy that contacts may make or lose in one step by its length alone, as a part of what
# passes through the run, at a tolerance of 1e-3; else the step is halved. 400 such steps make what the
# audit of a run allows.
MAY_MAKE = 5e-5

# Convention: steps that take more iterations than the one are halved, and doubled again where they take
# less than the other.
HARD, EASY = 8, 5

# Convention: with air a step takes as many where it is a hundred times as short,
# since friction and the normal forces that it wedges go back and forth there, and a film passes that on at
# any step.
HARD_WITH_AIR, EASY_WITH_AIR = 14, 8

# Convention: steps of one run.
MOST_STEPS = 1e9

# -- The iterations of a step
# Convention: iterations of a step of FIRST_STEP stop at changes of velocity of this part of tolerance
# times speed: in scenes with flexible sheets, whose boxes flutter much faster, and of rigid blocks, whose
# impacts are sharp.
ROUND_OFF, ROUND_OFF_RIGID = 2.0, 0.02

# Convention: tolerance that a step is solved to, at most.
LOOSEST = 1e-2

# Convention: Newton iterations of one step before it is given up.
NEWTON_MOST = 40

# Convention: where nothing touches, a change is this part of what it may be else: a free sheet keeps its
# angular momentum as well as its iterations end.
FREE = 1e-5

# Convention: forces of sheets on sheets are those before an iteration that changed less than this part of
# the limit that holds where they move.
SAME_FORCES = 1e-3

# Convention: numerical damping of joints, as a part of half a step for 1 ms of it, and at most.
LAG, LAG_MOST = 1.0, 0.3

# Convention: contacts are solved for to this many times the step's own limit in an iteration.
CONTACT_ROUGH = 100.0

# Convention: in scenes of sheets on sheets so many iterations with contacts apart from the matrix, or with
# those of fixed plates alone in it, are enough; then all stand in it. From so many iterations of a step on a
# convex problem is solved to its end, and more changes are mixed.
CONVEX_AFTER = 8

# Convention: for so many steps all contacts stand in the matrix then.
CONVEX_FOR = 200.0

# Convention: how much of the chord a matrix has of contacts with fixed plates (see slopes.steepness):
# little converges fast; much does not cross to the other side of what is flat, after an iteration that
# left more than the last part of the change before.
PLATE_CHORD, PLATE_CHORD_CAREFUL, CAREFUL_ABOVE = 0.05, 0.7, 0.9

# Convention: what a step counts in the choice of a guess, as a part of the one after it.
REMEMBERED = 0.5

# Convention: what a parabola misses is less than this part of what the others do, as squares, or it was by
# chance.
SMOOTH = 0.5

# Convention: iterations that are mixed, beside the present one.
MIXED = 5

# Convention: one alone is mixed within these bounds.
LEAST_MIXED, MOST_MIXED = -5.0, 0.9

# [mm^2] Convention: what turning counts in the mixing of changes.
TURNING_COUNTS = 10.0

# Convention: what is so much alike, as a part of a change squared, is not distinguished from round-off.
ALIKE = 1e-10

# -- The convex problem of an iteration, with all contacts in the matrix
# Convention: iterations, before it counts as not at its end.
CONVEX_MOST = 25

# Convention: cells of air have much in common that the matrix does not know, so it takes more
# of them, and exact searches.
CONVEX_MOST_WITH_AIR = 80

# Convention: what it leaves, in times what the step's own iterations may leave.
CONVEX_ROUGH = 0.3

# Convention: what closes against air is slow beside all else: it leaves this part of what the step may.
AIR_FINE = 0.02

# Measured at an earlier state, on a pile at rest, which cost least with this part: a linear solve leaves this
# part of what the step may, in the root mean square over a sheet, where that comes before the end that it
# has by itself. What is left stays in the next step's residual.
SOLVED = 0.01

# Convention: a direction is gone along wholly where the slope at its end is less than this part of that at
# its begin, and else to where it is less than the other part.
SLOPE_WHOLE, SLOPE_FOUND = 0.25, 0.1

# Convention: looks of such a search, and how often it goes twice as far.
SEARCH_LOOKS, SEARCH_DOUBLED = 12, 4

# Convention: a first direction that is gone along wholly is enough for one of the step's own iterations
# where it moves by less than so many times what the step may leave: beyond, more of them take less than
# another evaluation.
FIRST_DIRECTION = 10.0

# Convention: a factor may have contacts that held a sheet in an earlier state and no longer do, so a
# change is too small. Where what is left of its momentum would move a sheet by more than FIRST_DIRECTION
# if nothing held it, a change must leave less than this part of it, or the factor is made anew.
CURED = 0.5

# Convention: how much of the chord a factor takes (see slopes.steepness): little, since each direction is
# searched.
CONVEX_CHORD = 0.05

# [mm] Convention: how far two faces may be open at a corner that may close in an iteration.
REACH = 0.003

# Convention: conjugate gradients of a linear solve.
LINEAR_MOST = 200

# Convention: what may be left of the square of the residual, measured with the preconditioner. An
# iteration of Newton's method leaves more itself where contacts open and close, so less costs iterations
# here and saves none there. The method goes on after it, and loses no momentum to it (see momentum.keep).
LINEAR_LEFT = 1e-3

# Convention: the matrix has of air what each cell does alone, so much of a direction is wrong anyhow.
LINEAR_LEFT_WITH_AIR = 1e-2

# Convention: a cell alone is so many times as stiff as its neighbours make it where they have no pressure.
CELL_ALONE = 2.0

# Convention: the air at the end of a step: iterations at most, and what they leave of the residual,
# squared.
AIR_MOST, AIR_LEFT = 60, 1e-12

# -- Contacts apart from the matrix
# Convention: iterations, and how often one is halved.
APART_MOST, APART_HALVED = 40, 4

# Convention: how much of the chord a derivative takes (see slopes.core): little first, much where that
# went astray.
CHORD, CHORD_CAREFUL = 0.0, 0.7

# Convention: factors are used again where an iteration left less than this of the squares.
USED_AGAIN = 0.04

# Convention: an iteration that moves less than this times what is strictly wanted is not looked at again.
NEARLY = 10.0

# Convention: boxes that may stand apart in any case. With more than stand apart, all contacts stand in a
# matrix without the growth of friction with the normal force, and steps are halved where friction is high.
FEWEST_APART = 48

# [bytes] Convention: memory for columns of the inverse.
COLUMNS = 64e6

# -- Factors that serve many steps
# Convention: a new factor, and columns for each box that touches, cost as
# much as this many iterations: it is made where more of them are still to come at the rate of the last
# two.
FACTOR_WORTH = 3.0

# Convention: the same where all contacts stand in it.
CONVEX_FACTOR_WORTH = 4.0

# Convention: one that has served so many solves beyond one for each step is made anew: what would be saved
# by that is not known, and has been spent by then.
FACTOR_SERVES = 8.0

# Convention: steps for which a factor of dampers is good: a sheet bends little in so many.
DAMPERS_LAST = 50

# -- Pairs that are near, and what a step may pass
# [mm] Convention: pairs that are closer than this, and what moves in a step, are looked at in it.
FAR = 0.05

# [mm] Convention: how far boxes are found that may come near before the next search.
SKIN = 2.0

# Convention: pairs that there is room for, in times those of two flat sheets on each other.
ROOM = 3.0

# Derived: the part of what boxes may move that two sheets may move together until the next look. A look
# sees to it that twice that is left: a step may be taken again from its state, the other way.
MOVED_UP_TO = 1.0 / 3.0

# [mm], [-] Convention: how much nearer pairs may come before they are listed anew, where a step takes no
# more of it than the other part.
SPARE, SPARE_PART = 0.01, 0.2

# Convention: what two boxes may come closer in one iteration, in half thicknesses of the thinner one.
CLOSER = 0.5

# Convention: pairs that would have to be looked at more often in a step want a smaller one.
SWEPT_MOST = 64

# Convention: contacts of which each makes less than this part of the energy that may be made are not
# looked at.
SWEPT_LITTLE = 1e-3

# Convention: two rollers with a sheet between them clear each other by a few micrometres and may graze: a
# force below this part of the greatest is not counted as the nip still acting.
GRAZE = 0.05

# -- Islands, round-off and sleep
# Convention: least distance that a part is measured by, relative to the length of a sheet, the radius of a
# roller or the thickness of a plate: the least that `run.tolerance` is relative to (see
# results.estimates).
LEAST_WAY = 0.1

# Convention: where sheets may lie on each other, iterations follow a part down to the one part of its
# least speed, as a divisor, and leave the other of it at least: the midpoint rule damps nothing, so what
# they leave in a pile at rest would ring on.
FOLLOWED, STILL = 10.0, 0.005

# Derived: velocities are not resolved below so many units in the last place of a box's coordinates over
# half of the step: a relative place is a sum of two coordinates and two arms, each of them rounded twice.
UNITS = 8.0

# Derived: of a double.
EPSILON = 2.0**-52

# Convention: how long a sheet is still before it sleeps: a part of the run, and steps at least.
STILL_FOR, STILL_STEPS = 0.05, 20

# Convention: how often at most a pass checks whether sheets fall asleep, parts overlap and halves pass
# their plane: as often as it stores a state by default.
LOOKS = 200

# -- Passes of a run
# Convention: two runs that end early end at the same time where it differs by less than this part of the
# duration.
SAME_END = 0.01

# [s] Convention: a first pass that takes less has a third begun where it is needed alone.
SHORT = 0.25

# Convention: how often the step was halved when it is first asked whether a motion is chaotic: four runs show
# whether their differences fall, and half of the way to MOST_REFINED has a fifth of the cost.
ASKED = 3

# Convention: a step that is given is compared with twice that step where the run has so many of them.
FEWEST_COMPARED = 4

# [s] Convention: where `run.limit` is not set a search begins no pass with which all of them would take
# more wall time, and ends one that does where there is a result: a designer waits a minute for it, of which
# a little is left for estimates, and may ask for more.
PATIENCE = 55.0

# Derived: a pass takes at least so much longer than that at twice its step: it has twice as many steps.
TWICE = 2.0

# Convention: states, stored times by bodies, of a run that is only compared with another one: those of a
# pile of a hundred sheets would take as much memory as half of what its steps work on.
COMPARED = 1_000_000

# Convention: bodies, times states, whose rotations are looked at together.
TOGETHER = 20_000

# Convention: steps that compiled code takes before it is asked again.
MOST_AT_ONCE = 1000

# [s] Convention: how long a call of compiled code is meant to take, since between two the clock is read;
# and how often bounds are withdrawn of what a pass works on, once the time is over.
CALL, CUT_AGAIN = 0.25, 0.05

# [s] Convention: between two stored times a pass reports after so much wall time.
REPORTED = 0.5

# Convention: halvings of the step from which on it names what holds it up: it takes 16 times as long as
# was meant.
HELD_UP = 4

# -- Models at rest
# Convention: iterations to one balance.
BALANCE_MOST = 100

# Convention: lengths of one step that are tried.
BALANCE_TRIES = 12

# [rad] Convention: what a step may turn one box against the next.
MOST_TURN = 0.3

# Convention: residual that ends the iterations, relative to the load, and one that is good enough where it
# falls no more.
REST, REST_AT_LEAST = 1e-9, 1e-6

# [rad], parts of a box. Convention: a step that ends the iterations where round-off hides the residual.
BALANCE_STILL = 1e-8

# Convention: parts of the stiffest that are added to the diagonal where the matrix is not positive.
LEAST_SHIFT, FIRST_SHIFT, MOST_SHIFT = 1e-12, 1e-10, 1e6

# Convention: of the entries of a stiffness, what round-off makes of its sums, times their number.
NOISE = 1e-13

# [N], parts of a box. Convention: what a balance does not come back from.
NO_WAY_BACK = 1e30

# Convention: of the stiffest, holds what hangs on nothing where a chain of boxes follows its joints.
HANGS_ON_NOTHING = 1e-12

# [mm], [rad] Convention: differences by which the stiffness of contacts is found.
DIFFERENCE = 1e-6

# Convention: of the load, the part that is tried first, and the least that is added at a time.
FIRST_PART, LEAST_PART = 1.0, 1e-4

# Convention: iterations up to which a part grows, and after which a part that fails ends the run.
FEW_ITERATIONS, MANY_ITERATIONS = 30, 2000

# Convention: iterations after which no other part is begun: a hard sheet bent both ways takes many that do
# not fail.
REST_MOST = 200_000

# Convention: of the stiffest: holds sheets that lie on contacts only along what does not hold them.
TETHER = 1e-9

# [rad/ms] Convention: a balance that is left so slowly that it grows e-fold in ten seconds stands still.
STANDS = 1e-4

# Convention: halvings between a load at which a balance stands and one at which it does not.
STANDING_HALVINGS = 10

# Derived: relative difference of both bounds that ends the search: a tenth of the residual of a balance,
# REST_AT_LEAST.
LIMIT_CLOSE = 1e-7

# Convention: twists; 20 to 60 are enough for LIMIT_CLOSE.
LIMIT_MOST = 300

# Convention: a contact that leans by 90 degrees less the angle of friction may hold any force along the
# plane: its ellipse becomes a parabola. One that is closer to that than this part of the cone's cosine
# squared counts as a wall, which holds nothing along the plane beyond its own force.
STEEP = 0.05

# [mm] Convention: how far what holds a sheet gives way under the load that residuals are measured by.
GIVES = 1e-4

# Convention: of that load, a force along the plane below this is none.
NO_FORCE = 1e-6

# Convention: a sheet that turns about a centre further off than this many times the reach of its contacts
# slides.
SLIDES_BEYOND = 10.0

# Convention: balances that are found anew for what friction adds at edges, and its change, of the load,
# that ends them.
MOST_GRIPS, STEADY = 40, 1e-7

# Measured at an earlier state: places over which the pressure of a sheet is spread, about, and of the side
# of a triangle of a face: with 8 the couple that one square face holds is within 0.3 %.
PLACES, TRIANGLES = 4000, 8

# Convention: cosine of the angle by which normals of corners of one face differ at most, 1 less this.
NORMALS_ALIKE = 1e-9

# -- Symmetry
# Convention: how well both sides must agree, relative to the largest number that is compared.
SAME = 1e-9

# Convention: and in forces that sum up.
SAME_FORCE = 1e-7

# [mm], [rad], and per ms. Convention: motion for the comparison of forces.
MOVED, TURNED = 1e-3, 1e-2
