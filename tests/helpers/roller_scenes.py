"""A roller over a plane, a guide or a mesh, and what it must rest at."""

from __future__ import annotations

from papers import on_paper

SOLVERS = ["lattice", "exudyn"]
G = 9.81e-3  # mm/ms^2
K, N, SPRING, MASS, RADIUS = 40.0, 3.0, 0.5, 12.0, 10.0
# a strip that is clamped out of the way, and a roller over what `parts` holds
SCENE = """
name: contact
gravity: {gravity}
materials: {{p: {{E_md: 3 GPa, E_cd: 3 GPa, D_md: 1 N*mm, D_cd: 1 N*mm}}}}
sheets:
  strip: {{material: p, size: [20 mm, 10 mm], thickness: 0.1 mm, mass: 0.02 g, boxes: [4, 2],
    center: [0 mm, 300 mm, 0 mm], clamp: {{edge: x_min}}}}
rollers:
  r: {{center: {center}, axis: {axis}, radius: 10 mm, width: 16 mm, mass: 12 g{more}}}
{parts}
contacts:
  - {{between: [r, part], stiffness: 40 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 0.5 mm/s}}
run: {{duration: 20 ms, print_step: 0.1 ms}}
"""
DOWN = "[0 m/s^2, 0 m/s^2, -9.81 m/s^2]"
NONE = "[0 m/s^2, 0 m/s^2, 0 m/s^2]"
PLANE = "planes: {part: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 60 mm, 10 mm], mass: 1 g}}"
LINE = (
    "guides: {{part: {{width: 60 mm, line: {{from: [-50 mm, 0 mm, 0 mm], to: [50 mm, 0 mm, 0 mm], "
    "axis: y, side: {side}}}}}}}"
)
ARC = (
    "guides: {{part: {{width: 60 mm, arc: {{center: [0 mm, 0 mm, {z} mm], axis: y, radius: 30 mm, "
    "from: {begin} deg, to: {end} deg, side: {side}}}}}}}"
)
PICK = on_paper("""
name: pick
materials: {p: PLATE_PAPER}
sheets: {n: {material: p, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.19 g, boxes: [12, 4],
  layout: plate, center: [0 mm, 0 mm, 0.05 mm]}}
rollers: {pick: {center: [0 mm, 0 mm, 10.1 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 10 g,
  drive: {speed: -100 rad/s, ramp: 2 ms}, press: {direction: -z, stiffness: 0.3 N/mm, preload: 2 N}}}
planes: {table: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 100 mm, 10 mm], mass: 1 g}}
contacts:
  - {between: [n, pick], stiffness: 300 N/mm^1.5, friction: 1, smoothing: 5 mm/s}
  - {between: [n, table], stiffness: 300 N/mm^1.5, friction: 0.2, smoothing: 5 mm/s}
  - {between: [pick, table], stiffness: 300 N/mm^1.5, friction: 0.2, smoothing: 5 mm/s}
run: {duration: 60 ms, margin: 30 mm}
""")


def scene(parts: str, more: str = "", gravity: str = NONE, center: str = "", axis: str = "y") -> str:
    return SCENE.format(
        parts=parts,
        more=more and ", " + more,
        gravity=gravity,
        center=center or "[0 mm, 0 mm, 10 mm]",
        axis=axis,
    )


def press(way: str = "-z", preload: float = N, stiffness: float = SPRING) -> str:
    spring = f"stiffness: {stiffness} N/mm, preload: {preload} N, damping_ratio: 0.3"
    return f"press: {{direction: {way}, {spring}}}"


def depth(force: float, spring: float = SPRING, share: float = 1.0) -> float:
    """z with share k z^1.5 = force - spring z, by bisection (F = k z^1.5: Eq. 10 of the paper)."""
    low, high = 0.0, 5.0
    for _ in range(200):
        z = 0.5 * (low + high)
        low, high = (z, high) if share * K * z**1.5 < force - spring * z else (low, z)
    return low


def spun(omega: float) -> str:
    """A roller that begins to turn with a shaft, which stops at once and leaves it free."""
    profile = f"[[0 ms, {omega} rad/s], [0.001 ms, 0 rad/s]]"
    return f"drive: {{profile: {profile}}}, one_way: {{direction: 1, torque: 1 N*mm}}"
