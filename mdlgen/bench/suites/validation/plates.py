"""A sheet of layout plate, clamped at one end: in torsion, and bent in its own plane."""

from __future__ import annotations

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import loaded, plate
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

SAMPLE = "verify/rollup"
# In torsion: D along and across, D66 [N mm]. The end turns by 2 mrad only: by Wagner's effect a strip that is
# twisted by theta' bears E s theta'^3 W^5/360 more, since its edges are stretched, 1.7 % at ten times that.
TWISTED, ALONG, ACROSS, TWIST = (90.0, 24.0), 0.35, 0.21, 0.13
TORQUE = 2.5e-4  # [N mm]
GRIDS = ((20, 4), (40, 8))
RITZ = "Ritz: polynomials for 1/2 int D_x w_xx^2 + D_y w_yy^2 + 4 D66 w_xy^2 (Timoshenko, Woinowsky-Krieger)"
# Bent in its plane; so thick that it does not tip over.
DEEP, THICK, MODULUS, SHEAR, PUSH = (60.0, 20.0), 2.0, 1200.0, 380.0, 1.0
TIMOSHENKO = "Timoshenko: P L^3/(3 E I) + 6/5 P L/(G A)"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or the coarse ones."""
    grids = GRIDS[:1] if quick else GRIDS
    return [*(_torsion(grid) for grid in grids), _in_plane((24, 8))]


def _sheet(size: tuple[float, float], thickness: float, grid: tuple[int, int]) -> str:
    return (
        f"sheets={{strip: {{material: foil, size: [{size[0]} mm, {size[1]} mm], thickness: {thickness} mm,"
        f" mass: 1 g, boxes: [{grid[0]}, {grid[1]}], layout: plate, clamp: {{edge: x_min}}}}}}"
    )


def _torsion(grid: tuple[int, int]) -> BenchCase:
    material = (
        f"materials={{foil: {{E_md: 3000 MPa, E_cd: 2000 MPa, D_md: {ALONG} N*mm, D_cd: {ACROSS} N*mm,"
        f" D_twist: {TWIST} N*mm}}}}"
    )
    length, width = TWISTED
    corners = [f"at: [{length / 2} mm, {side * width / 2} mm]" for side in (-1, 1)]
    forces = [f"force: [0 N, 0 N, {side * TORQUE / width!r} N]" for side in (-1, 1)]
    loads = ", ".join(f"{{sheet: strip, {at}, {force}}}" for at, force in zip(corners, forces, strict=True))
    probes = f"{{starboard: {{sheet: strip, {corners[0]}}}, port: {{sheet: strip, {corners[1]}}}}}"
    run = Run(SAMPLE, (material, _sheet(TWISTED, 0.1, grid), f"loads=[{loads}]", f"probes={probes}"))
    return row("Plates", f"strip in torsion, {grid[0]} x {grid[1]} boxes", run, twists)


def _in_plane(grid: tuple[int, int]) -> BenchCase:
    bending = MODULUS * THICK**3 / 12
    material = (
        f"materials={{foil: {{E_md: {MODULUS} MPa, E_cd: {MODULUS} MPa, G: {SHEAR} MPa,"
        f" D_md: {bending} N*mm, D_cd: {bending} N*mm, D_twist: {bending / 2} N*mm}}}}"
    )
    load = f"loads=[{{sheet: strip, edge: x_max, force: [0 N, {PUSH} N, 0 N]}}]"
    run = Run(SAMPLE, (material, _sheet(DEEP, THICK, grid), load))
    return row("Plates", f"strip bent in its plane, {grid[0]} x {grid[1]} boxes", run, shears)


def twists(result: Result, _: Result | None) -> list[Finding]:
    """Turn of the free end over the torque of two opposite forces at its corners, from where these go."""
    names = [probe.name for probe in result.model.probes]
    port, starboard = (result.anchor_motion(names.index(name))[0] for name in ("port", "starboard"))
    found = float(port[-1, 2] - starboard[-1, 2]) / TWISTED[1] / TORQUE
    expected = plate.torsion(*TWISTED, ALONG, ACROSS, TWIST)
    basis = Basis(RITZ, "the grid, of second order: 0.3 % at 40 x 8")
    return [against("turn / torque", expected, found, 1.2e-2, "rad/(N mm)", basis)]


def shears(result: Result, _: Result | None) -> list[Finding]:
    """Deflection of the end."""
    found = float(result.anchor_motion(0)[0][-1, 1])
    expected = loaded.sheared(*DEEP, THICK, MODULUS, SHEAR, PUSH)
    basis = Basis(TIMOSHENKO, "shear is a tenth of it, and the clamp holds it as a wall does; 8 boxes across")
    return [against("deflection", expected, found, 1e-2, "mm", basis)]
