"""Settings of Exudyn's solvers."""

from __future__ import annotations

# Spectral radius of the generalised-alpha rule: 1 would keep the noise of contact changes, 0 damps most.
SPECTRAL_RADIUS = 0.6
# Newton's tolerance: the default 1e-10 lies below the round-off of stiff bushings (k eps |x|).
NEWTON_TOLERANCE = 1e-8
# Relative to the load of one step; what counts is our own check of the residual at the end.
STATIC_TOLERANCE = 1e-8
# A step may shrink to this part of the wanted one before the run fails.
SMALLEST_STEP = 1e-3


def settings_of(
    exu, count: int, end: float, touching: bool, begin: float = 0.0, residual: float = NEWTON_TOLERANCE
):
    """Exudyn's settings for `count` steps from `begin` to `end` [s], or of the load of a static run, where
    `end` is 0 and `residual` [N] is allowed."""
    s = exu.SimulationSettings()
    s.solution.file.write = False
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    s.parallel.numberOfThreads = 1
    static = s.staticSolver
    static.newton.absoluteTolerance = min(NEWTON_TOLERANCE, residual)
    static.newton.relativeTolerance = STATIC_TOLERANCE
    static.newton.maxIterations = 40
    static.numberOfLoadSteps = count
    static.verboseMode = 0
    if end == 0.0:
        return s
    t = s.timeIntegration
    t.newton.useModifiedNewton = True
    t.newton.absoluteTolerance = t.newton.relativeTolerance = NEWTON_TOLERANCE
    t.newton.maxIterations = 12
    t.verboseMode = 0
    t.numberOfSteps = count
    t.startTime, t.endTime = begin, end
    t.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    # Accelerations at the start are wanted for accuracy; but in contact the stiff damping makes them so
    # large for a moment that Newton would start far away. Such scenes start at rest in their nips.
    t.generalizedAlpha.computeInitialAccelerations = not touching
    t.adaptiveStep = True  # a step that does not converge is repeated at half the size
    t.adaptiveStepDecrease = 0.5
    t.adaptiveStepIncrease = 2.0
    t.adaptiveStepRecoverySteps = 1
    t.minimumStepSize = (end - begin) / count * SMALLEST_STEP
    return s
