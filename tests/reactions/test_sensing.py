"""What sensors see: against the geometry of flat sheets, for any place and turn."""

from __future__ import annotations

import math

import numpy as np
import pytest

import mdlgen
from mdlgen.reactions.sensing import Eye, Poses, between

MATERIAL = {"E_md": "3000 MPa", "E_cd": "1500 MPa", "D_md": "0.3 N*mm", "D_cd": "0.2 N*mm"}


def eye(boxes: tuple[int, int], **sensor) -> tuple[Eye, Poses]:
    scene = mdlgen.Scene.model_validate(
        {
            "name": "eye",
            "materials": {"p": MATERIAL},
            "sheets": {
                "note": {"material": "p", "size": ["60 mm", "40 mm"], "thickness": "0.1 mm", "mass": "0.3 g"}
                | {"boxes": list(boxes)}
            },
            "sensors": {"eye": sensor},
        }
    )
    model = mdlgen.lower(scene)
    bodies = model.bodies
    n = len(bodies.name)
    poses = Poses(bodies.position, bodies.rotation.reshape(n, 9), np.zeros((n, 3)), np.zeros((n, 3)))
    return Eye(model, model.reactions.sensors[0]), poses


def moved(poses: Poses, x: float, y: float, angle: float) -> Poses:
    """The flat sheet turned about its middle by an angle about z, and there."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    place = poses.x @ turn.T + [x, y, 0.0]
    rotation = (turn @ poses.r.reshape(-1, 3, 3)).reshape(-1, 9)
    return Poses(place, rotation, np.zeros_like(place), np.zeros_like(place))


def mm(*values: float) -> list[str]:
    return [f"{value!r} mm" for value in values]


@pytest.mark.parametrize("boxes", [(1, 1), (8, 5)])
def test_a_beam_sees_the_rectangle_of_the_sheet(boxes: tuple[int, int]) -> None:
    own, start = eye(boxes, beam=[mm(0.0, 0.0, -4.0), mm(1.0, -2.0, 5.0)])
    rng = np.random.default_rng(1)
    # where the beam goes through the plane z = 0
    through = np.array([4.0, -8.0]) / 9.0
    for x, y, angle in rng.uniform((-50, -40, -3), (50, 40, 3), (300, 3)):
        off = float(own.off(0, moved(start, x, y, angle)).min())
        c, s = math.cos(angle), math.sin(angle)
        dx, dy = through - (x, y)
        inside = max(abs(c * dx + s * dy) - 30.0, abs(-s * dx + c * dy) - 20.0)
        assert (off < 0.0) == (inside < 0.0)
        if inside > -2.0:  # within, boxes that reach into each other know no further than themselves
            assert off == pytest.approx(inside, abs=1e-9)
        else:
            assert off <= -1.0


def test_no_line_between_boxes_is_an_edge() -> None:
    own, start = eye((8, 5), beam=[mm(0.0, 0.0, -4.0), mm(0.0, 0.0, 5.0)])
    for x in np.linspace(-29.0, 29.0, 117):  # lines between boxes are every 7.5 mm
        assert float(own.off(0, moved(start, x, 0.0, 0.0)).min()) < -0.9


@pytest.mark.parametrize("boxes", [(1, 1), (8, 5)])
def test_a_line_sees_what_crosses_it_and_no_more(boxes: tuple[int, int]) -> None:
    ends = np.array([[0.0, -6.0], [0.0, 6.0]])
    own, start = eye(boxes, line=[mm(0.0, -6.0, -2.0), mm(0.0, 6.0, -2.0)], direction="z")
    rng = np.random.default_rng(2)
    half = np.array([30.0, 20.0])
    many = np.linspace(0.0, 1.0, 4001)[:, None]
    for x, y, angle in rng.uniform((-60, -60, -3), (60, 60, 3), (300, 3)):
        off = float(own.off(0, moved(start, x, y, angle)).min())
        c, s = math.cos(angle), math.sin(angle)
        points = (ends[0] + many * (ends[1] - ends[0]) - (x, y)) @ np.array([[c, -s], [s, c]])
        depth = (np.abs(points) - half).max(axis=1).min()  # of the point that is deepest
        if abs(depth) > 4e-3:  # points are 3 um apart
            assert (off < 0.0) == (depth < 0.0)


def test_a_sensor_sees_as_far_as_it_reaches() -> None:
    own, start = eye((4, 3), point=mm(0.0, 0.0, -3.0), direction="z", reach="4 mm")
    for z, seen in ((0.5, True), (1.5, False), (-3.5, False), (-2.5, True)):
        poses = start._replace(x=start.x + np.array([0.0, 0.0, z]))
        assert (float(own.off(0, poses).min()) < 0.0) == seen


@pytest.mark.parametrize("angle", [0.0, 2.0, -5.0])
def test_passing_is_as_the_sheet_goes(angle: float) -> None:
    turn = math.radians(angle)
    own, start = eye((6, 4), point=mm(32.0, 4.0, -3.0), direction="z")
    poses = moved(start, 3.0, 1.0, turn)
    going = poses._replace(u=np.broadcast_to([0.4, 0.0, 0.0], poses.x.shape).copy())
    by = own.passing(0, going)
    assert by.speed == pytest.approx(0.4, rel=1e-12)
    assert math.degrees(by.skew) == pytest.approx(angle, abs=1e-9)
    assert by.position == pytest.approx(1.0 - 4.0, abs=1e-9)  # z x x = y


def test_a_state_between_two_turns_by_their_mean_rate() -> None:
    _, start = eye((1, 1), point=mm(0.0, 0.0, 0.0), direction="z")
    spin = np.array([[0.0, 0.0, 0.02]])
    one, two = start._replace(w=spin), moved(start, 3.0, 0.0, 0.2)._replace(w=spin)
    half = between(one, two, 0.5, 10.0)
    assert half.x == pytest.approx(np.array([[1.5, 0.0, 0.0]]))
    assert half.r == pytest.approx(moved(start, 0.0, 0.0, 0.1).r)
    assert start.after(0.0).r == pytest.approx(start.r)
    assert one.after(10.0).r == pytest.approx(two.r)
