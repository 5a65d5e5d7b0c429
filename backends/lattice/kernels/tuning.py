"""Every number of the solver that is not physics, with its unit, its meaning and its origin.

An origin is one of three. Derived: it follows, and the comment says from what. Measured: the named runs show
it, or showed it at an earlier state. Convention: a choice; the comment names the alternatives where they are
known. Numbers without a unit are ratios or counts. `tests/solvers/test_tuning.py` checks that no other file
has such numbers.
"""

from __future__ import annotations

# -- The size of a step
# [ms] Convention: longest first step at a tolerance of 1e-3. It scales with the root of the tolerance, since
# the error of the midpoint rule scales with the square of the step.
FIRST_STEP = 0.2

# Convention: most halvings of the step in the search that meets the tolerance: for flexible sheets, and for
# rigid blocks, whose runs are short.
MOST_REFINED, MOST_REFINED_RIGID = 5, 8

# Convention: most halvings of a step, down to a 16,000th.
HALVINGS_MOST = 14

# Convention: most halvings for accuracy alone; at most HALVINGS_MOST, which includes those for convergence.
FINEST = 12

# Convention: a step is repeated where its missed guess or its energy error exceeds the limit by this factor.
# Between the limit and this, only the next step is halved.
TAKEN_AGAIN = 4.0

# Convention: in the step choice of rigid blocks, velocities may differ from their guess by this part of the
# speed at a tolerance of 1e-3; else the step is halved. Sheets flutter, and always differ by more.
MAY_MISS = 1e-3

# Convention: energy error of contacts in one step, relative to the energy of their island, at a tolerance of
# 1e-3. Above it the step is halved. 400 such steps add up to the limit of the energy audit.
MAY_MAKE = 5e-5

# Convention: the step is halved where it took more iterations than HARD, and doubled again where it took
# fewer than EASY.
HARD, EASY = 8, 5

# Convention: with air a step needs this many iterations even where it is a hundred times as short. Friction
# and the normal forces that it wedges alternate there, and a film transmits that at any step.
HARD_WITH_AIR, EASY_WITH_AIR = 14, 8

# Convention: steps of one run.
MOST_STEPS = 1e9

# -- The iterations of a step
# Convention: iterations of a step of FIRST_STEP stop where velocities change by less than this times
# tolerance times speed. Boxes of flexible sheets flutter much faster than the sheet moves, so the limit is
# larger; impacts of rigid blocks are sharp, so it is smaller.
ROUND_OFF, ROUND_OFF_RIGID = 2.0, 0.02

# Convention: largest tolerance to which a step is solved.
LOOSEST = 1e-2

# Convention: Newton iterations of one step before it is given up.
NEWTON_MOST = 40

# Convention: where nothing touches, the limit on changes is multiplied by this: the error of a free sheet's
# angular momentum is the error at which its iterations end.
FREE = 1e-5

# Convention: contact forces between sheets are not evaluated again after a last iteration that changed
# velocities by less than this part of the limit in the fastest island.
SAME_FORCES = 1e-3

# Convention: numerical damping time of joints, as a part of half a step, per ms of step; and its upper bound.
LAG, LAG_MOST = 1.0, 0.3

# Convention: the contact solve inside an iteration ends at this many times the step's own limit.
CONTACT_ROUGH = 100.0

# Convention: in scenes of sheets on sheets, a step first condenses all contacts, or assembles only those with
# fixed plates. From this iteration on all are in the matrix. From this iteration on, also, each convex
# problem is solved to its end and more changes are mixed.
CONVEX_AFTER = 8

# Convention: for this many steps all contacts then remain in the matrix.
CONVEX_FOR = 200.0

# Convention: weight of the secant in the slopes of contacts with fixed plates (see slopes.steepness). A small
# value converges faster. A large value avoids overshooting where the force curve is flat; it is used after
# an iteration whose change was more than CAREFUL_ABOVE of the change before.
PLATE_CHORD, PLATE_CHORD_CAREFUL, CAREFUL_ABOVE = 0.05, 0.7, 0.9

# Convention: weight of a step in the choice of a guess, relative to the step after it.
REMEMBERED = 0.5

# Convention: the parabola is chosen where its squared error is below this part of that of the other guesses.
# A smaller advantage may be a coincidence.
SMOOTH = 0.5

# Convention: number of earlier iterations that are mixed with the present one.
MIXED = 5

# Convention: bounds of the mixing coefficient where only one earlier iteration is mixed.
LEAST_MIXED, MOST_MIXED = -5.0, 0.9

# [mm^2] Convention: weight of squared angular velocities against squared velocities in mixing.
TURNING_COUNTS = 10.0

# Convention: added to the diagonal of the scaled Gram matrix in mixing: changes whose squared difference is
# smaller, relative to their square, cannot be distinguished from round-off.
ALIKE = 1e-10

# -- The convex problem of an iteration, with all contacts in the matrix
# Convention: most iterations of the convex problem; after them it counts as not converged.
CONVEX_MOST = 25

# Convention: the matrix lacks the couplings between cells of air, so the problem needs more iterations, and
# exact line searches.
CONVEX_MOST_WITH_AIR = 80

# Convention: residual of the convex problem, relative to the limit of the step's own iterations.
CONVEX_ROUGH = 0.3

# Convention: the same factor with air: sheets close against air much slower than all other motion.
AIR_FINE = 0.02

# Measured at an earlier state, on a pile at rest, which took the least time with this value: a linear solve
# ends at this part of the step's limit (root mean square over a sheet), or at LINEAR_LEFT if it meets that
# first. The remainder enters the next step's residual.
SOLVED = 0.01

# Convention: a line search takes the whole direction where the slope at its end is below SLOPE_WHOLE of that
# at its beginning. Otherwise it ends where the slope is below SLOPE_FOUND of that.
SLOPE_WHOLE, SLOPE_FOUND = 0.25, 0.1

# Convention: most evaluations of a line search, and most doublings of its length.
SEARCH_LOOKS, SEARCH_DOUBLED = 12, 4

# Convention: the first direction, taken wholly, is enough for one of the step's own iterations where it
# changes velocities by less than this many times the step's limit. Above that, more directions cost less
# than another evaluation of the forces.
FIRST_DIRECTION = 10.0

# Convention: a factor may contain contacts that have opened since, which makes a change too small. Where the
# residual momentum would move the sheet, if nothing held it, by more than FIRST_DIRECTION, a change must
# reduce that velocity to this part, or the matrix is refactored.
CURED = 0.5

# Convention: weight of the secant in a factor (see slopes.steepness): small, since a line search follows
# each direction.
CONVEX_CHORD = 0.05

# [mm] Convention: widest opening between two faces at a corner that may close in an iteration.
REACH = 0.003

# Convention: most conjugate-gradient iterations of a linear solve.
LINEAR_MOST = 200

# Convention: part of the squared residual, in the norm of the preconditioner, at which a linear solve ends. A
# Newton iteration itself leaves more where contacts open and close, so a smaller value costs iterations
# here and saves none there. Momentum is not lost: momentum.keep corrects it.
LINEAR_LEFT = 1e-3

# Convention: the same with air: the matrix contains each cell alone, so a direction is inaccurate anyway.
LINEAR_LEFT_WITH_AIR = 1e-2

# Convention: factor on the damping of one cell in the matrix, relative to a cell whose neighbours have no
# pressure.
CELL_ALONE = 2.0

# Convention: air at the end of a step: most iterations, and the part of the squared residual that ends them.
AIR_MOST, AIR_LEFT = 60, 1e-12

# -- Condensed contacts
# Convention: most iterations, and most halvings of one.
APART_MOST, APART_HALVED = 40, 4

# Convention: weight of the secant in a derivative (see slopes.core): none at first, much after an iteration
# that had to be shortened.
CHORD, CHORD_CAREFUL = 0.0, 0.7

# Convention: factors are reused where an iteration reduced the squared residual below this part.
USED_AGAIN = 0.04

# Convention: the solve ends without another evaluation after an iteration that changed velocities by less
# than this times the strict limit.
NEARLY = 10.0

# Convention: number of boxes that may be condensed in any case. Above the limit all contacts are assembled
# into a matrix without the growth of friction with the normal force, and high friction halves the steps.
FEWEST_APART = 48

# [bytes] Convention: memory for cached columns of the inverse.
COLUMNS = 64e6

# -- Factors that serve many steps
# Convention: a new factor, and columns for each box that touches, cost as much as this many iterations. The
# matrix is refactored where the convergence rate of the last two predicts more of them.
FACTOR_WORTH = 3.0

# Convention: the same where all contacts are in the matrix.
CONVEX_FACTOR_WORTH = 4.0

# Convention: the matrix is refactored after this many solves beyond one per step: by then they have cost as
# much as a new factor.
FACTOR_SERVES = 8.0

# Convention: number of steps for which a factor of dampers is reused: a sheet bends little in them.
DAMPERS_LAST = 50

# -- Near pairs, and checks of a step for pairs that cross
# [mm] Convention: pairs are evaluated in a step where their gap is below this plus their motion in the step.
FAR = 0.05

# [mm] Convention: gap up to which a search lists boxes, since they may come near before the next search.
SKIN = 2.0

# Convention: capacity for pairs, relative to the pairs of two flat sheets on each other.
ROOM = 3.0

# Derived: two sheets may move together by this part of the distance for which an overlap holds, until it is
# checked again. A check leaves twice that: a step may be repeated from its state, the other way.
MOVED_UP_TO = 1.0 / 3.0

# [mm], [-] Convention: how much nearer pairs may come before the list is rebuilt. The first holds where one
# step uses less than the second part of it; else the list holds for one step.
SPARE, SPARE_PART = 0.01, 0.2

# Convention: most approach of two boxes in one iteration, in half thicknesses of the thinner one.
CLOSER = 0.5

# Convention: most states of a pair that are checked within a step; a pair that needs more halves the step.
SWEPT_MOST = 64

# Convention: contacts whose energy error is at most this part of the allowed one are not evaluated.
SWEPT_LITTLE = 1e-3

# Convention: two rollers with a sheet between them have a gap of a few micrometres and may graze. A nip whose
# force is below this part of its greatest force counts as open.
GRAZE = 0.05

# -- Islands, round-off and sleep
# Convention: least distance that scales the errors of a part, relative to the length of a sheet, the radius
# of a roller or the thickness of a plate. `run.tolerance` is relative to it (see results.estimates).
LEAST_WAY = 0.1

# Convention: where sheets may lie on each other, the scale of errors of a part slower than its least speed is
# FOLLOWED times its speed, and at least STILL times its least speed. The midpoint rule damps nothing, so an
# error at the least speed would keep ringing in a pile at rest.
FOLLOWED, STILL = 10.0, 0.005

# Derived: velocities are not resolved below this many units in the last place of a box's coordinates, over
# half of the step: a relative place is the sum of two coordinates and two arms, each rounded twice.
UNITS = 8.0

# Derived: of a double.
EPSILON = 2.0**-52

# Convention: time for which a sheet is still before it sleeps: a part of the run, and a number of steps.
STILL_FOR, STILL_STEPS = 0.05, 20

# Convention: most checks in a pass for sheets that fall asleep, parts that overlap and halves that cross
# their plane: as many as it stores states by default.
LOOKS = 200

# -- Passes of a run
# Convention: the ends of two runs that end early agree where they differ by less than this part of the
# duration.
SAME_END = 0.01

# [s] Convention: after a first pass shorter than this, the third pass begins only once it is needed.
SHORT = 0.25

# Convention: halvings of the step after which a motion is first checked for chaos: four runs show whether
# their differences fall, and these cost a fifth of the runs up to MOST_REFINED.
ASKED = 3

# Convention: a prescribed step is compared with twice that step where the run has at least this many steps.
FEWEST_COMPARED = 4

# [s] Convention: wall time of all passes of a search where `run.limit` is not set. No pass begins that would
# exceed it, and a pass that exceeds it ends where there is a result. A designer waits a minute for a result,
# of which a little is left for estimates, and may set a longer limit.
PATIENCE = 55.0

# Derived: a pass takes at least this many times as long as one at twice its step: it has twice the steps.
TWICE = 2.0

# Convention: most states (stored times by bodies) of a run that serves for comparison only. More would need,
# for a pile of a hundred sheets, half as much memory as the arrays of its steps.
COMPARED = 1_000_000

# Convention: bodies times states whose rotations are evaluated in one array operation.
TOGETHER = 20_000

# Convention: most steps of one call of compiled code.
MOST_AT_ONCE = 1000

# [s] Convention: aimed duration of a call of compiled code, since the clock is read between two; and the
# interval at which a pass's bounds are withdrawn, to end it, once its time is over.
CALL, CUT_AGAIN = 0.25, 0.05

# [s] Convention: wall time between two reports of a pass.
REPORTED = 0.5

# Convention: halvings of the step from which on a report names the cause: the run takes 16 times as long as
# at the full step.
HELD_UP = 4

# -- Models at rest
# Convention: most iterations to one balance.
BALANCE_MOST = 100

# Convention: most lengths that are tried for one step.
BALANCE_TRIES = 12

# [rad] Convention: largest rotation of one box against the next in a step.
MOST_TURN = 0.3

# Convention: residual that ends the iterations, relative to the load, and one that is accepted where it no
# longer falls.
REST, REST_AT_LEAST = 1e-9, 1e-6

# [rad], parts of a box. Convention: length of a step that ends the iterations where round-off hides the
# residual.
BALANCE_STILL = 1e-8

# Convention: shift of the diagonal where the matrix is not positive, relative to its largest entry.
LEAST_SHIFT, FIRST_SHIFT, MOST_SHIFT = 1e-12, 1e-10, 1e6

# Convention: round-off error of the diagonal of a stiffness matrix, relative to its entries.
NOISE = 1e-13

# [N], parts of a box. Convention: residual or displacement above which iterations have diverged.
NO_WAY_BACK = 1e30

# Convention: stiffness that holds a free chain of boxes as it follows its joints, relative to the largest.
HANGS_ON_NOTHING = 1e-12

# [mm], [rad] Convention: finite differences for the stiffness of contacts.
DIFFERENCE = 1e-6

# Convention: part of the load that is tried first, and the smallest increment.
FIRST_PART, LEAST_PART = 1.0, 1e-4

# Convention: iterations of a balance up to which the increment of load grows, and iterations in all after
# which a failed increment ends the search.
FEW_ITERATIONS, MANY_ITERATIONS = 30, 2000

# Convention: iterations after which no other increment begins: a stiff sheet bent both ways needs many that
# do not fail.
REST_MOST = 200_000

# Convention: stiffness, relative to the largest, that holds sheets which lie on contacts alone along the
# directions in which these contacts do not hold them.
TETHER = 1e-9

# [rad/ms] Convention: a balance is stable where a disturbance needs ten seconds or more to grow e-fold.
STANDS = 1e-4

# Convention: halvings between a load with a stable balance and one without.
STANDING_HALVINGS = 10

# Derived: relative difference of both bounds that ends the limit search: a tenth of the residual of a
# balance, REST_AT_LEAST.
LIMIT_CLOSE = 1e-7

# Convention: most twists that are tried; 20 to 60 are enough for LIMIT_CLOSE.
LIMIT_MOST = 300

# Convention: a contact that leans by 90 degrees less the angle of friction may hold any force along the
# plane: its ellipse becomes a parabola. One that is closer to that than this part of the cone's cosine
# squared counts as a wall, which holds nothing along the plane beyond its own force.
STEEP = 0.05

# [mm] Convention: deflection of the springs that hold a sheet, under the load that scales residuals.
GIVES = 1e-4

# Convention: a force along the plane below this part of that load counts as zero.
NO_FORCE = 1e-6

# Convention: a sheet slides, and does not turn, where its centre of rotation is further away than this many
# times the reach of its contacts.
SLIDES_BEYOND = 10.0

# Convention: most repetitions of a balance for the friction at edges, and the change of that friction,
# relative to the load, that ends them.
MOST_GRIPS, STEADY = 40, 1e-7

# Measured at an earlier state: number of places over which the pressure of a sheet is spread, about, and
# number along the side of a triangle of a face. With 8 the couple of one square face is within 0.3 %.
PLACES, TRIANGLES = 4000, 8

# Convention: normals of the corners of one face agree where the cosine of their angle is above 1 - this.
NORMALS_ALIKE = 1e-9

# -- Symmetry
# Convention: largest difference of both sides, relative to the largest number that is compared.
SAME = 1e-9

# Convention: the same for forces, which are sums.
SAME_FORCE = 1e-7

# [mm], [rad], and per ms. Convention: displacements and velocities at which the forces are compared.
MOVED, TURNED = 1e-3, 1e-2
