"""Detours: out of the way of things, as little as needed, least where the demonstrations agree."""

import numpy as np
import pytest

from cobot_lfd.app.detour import detours, past_walls
from cobot_lfd.arrays import Array
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose

T = 100
STRAIGHT = np.column_stack([np.linspace(0.0, 0.4, T), np.zeros(T)])
RADIUS = np.hypot(0.02, 0.01)


def path(spread: Array | float = 0.01) -> GeneratedPath:
    """A straight path that may be left by ``spread`` [m]."""
    variance = np.broadcast_to(spread, T)[:, None, None] ** 2 * np.eye(2)
    return GeneratedPath(STRAIGHT, variance, np.linspace(0.0, 1.0, T))


def thing(x: float, y: float) -> Obstacle:
    return Obstacle(
        "thing", Pose(np.array([x, y, 0.01]), np.eye(3)), np.zeros((1, 3)), np.array([[0.02, 0.01, 0.01]])
    )


def test_nothing_in_the_way_asks_for_no_detour() -> None:
    assert not list(detours(path(), []))
    assert not list(detours(path(), [thing(0.2, 0.2)]))


def test_both_sides_are_offered_the_shorter_way_first() -> None:
    first, second, *_ = detours(path(), [thing(0.2, 0.02)])
    assert first[T // 2, 1] < 0 < second[T // 2, 1]
    assert np.abs(first[:, 1]).max() < np.abs(second[:, 1]).max()


@pytest.mark.parametrize("things", [[(0.2, 0.01)], [(0.15, 0.02), (0.28, -0.03)]])
def test_a_detour_keeps_its_distance_and_its_ends(things: list[tuple[float, float]]) -> None:
    found = list(detours(path(), [thing(*place) for place in things]))
    assert found
    for bent in found:
        np.testing.assert_allclose(bent[[0, -1]], STRAIGHT[[0, -1]], atol=1e-12)
        for place in things:
            assert np.linalg.norm(bent - place, axis=1).min() > RADIUS + 0.0498


def test_what_is_mirrored_is_passed_in_the_mirror() -> None:
    there, mirrored = (next(iter(detours(path(), [thing(0.2, y)]))) for y in (0.02, -0.02))
    np.testing.assert_allclose(there, mirrored * [1.0, -1.0], atol=1e-4)


def test_a_path_is_bent_where_the_demonstrations_leave_it_free() -> None:
    loose_early = path(np.where(np.arange(T) < T // 2, 0.05, 0.002))
    bent = next(iter(detours(loose_early, [thing(0.2, 0.02)])))
    strayed = np.abs(bent[:, 1])
    assert strayed[: T // 2].sum() > 1.3 * strayed[T // 2 :].sum()


def test_an_end_beside_a_thing_stays_where_it_is() -> None:
    for bent in detours(path(), [thing(0.03, 0.03)]):
        np.testing.assert_allclose(bent[0], STRAIGHT[0], atol=1e-12)


def slot(y: float, turn: float = 0.0) -> Obstacle:
    """Two walls along x on either side of the path's last quarter, its middle ``y`` beside the path."""
    centres = np.array([[0.35, y - 0.05, 0.02], [0.35, y + 0.05, 0.02]])
    half_sizes = np.array([[0.05, 0.02, 0.02]] * 2)
    return Obstacle("slot", Pose.from_rpy([0.0, 0.0, 0.0], [0.0, 0.0, turn]), centres, half_sizes)


def cutting_the_corner(turn: float = 0.0) -> GeneratedPath:
    """A path that touches a corner of that slot."""
    bow = np.column_stack([np.zeros(T), 0.06 * np.sin(np.linspace(0.0, np.pi, T)) ** 2])
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    return GeneratedPath((STRAIGHT + bow) @ rotation.T, path().covariance, path().times)


def distance(points: Array, obstacle: Obstacle) -> float:
    """Of the points from the boxes, as seen from above [m]."""
    local = obstacle.pose.inverse().apply(np.column_stack([points, np.zeros(len(points))]))[:, :2]
    beyond = np.abs(local[:, None] - obstacle.centres[:, :2]) - obstacle.half_sizes[:, :2]
    return float(np.linalg.norm(np.maximum(beyond, 0.0), axis=-1).min())


def test_a_path_that_cuts_the_corner_of_a_way_in_keeps_farther_from_it() -> None:
    cutting = cutting_the_corner()
    assert distance(cutting.mean, slot(0.0)) < 0.01
    first, *_ = past_walls(cutting, slot(0.0), [])
    np.testing.assert_allclose(first[[0, -1]], STRAIGHT[[0, -1]], atol=1e-12)
    assert distance(first, slot(0.0)) > 0.0248
    assert np.abs(first - cutting.mean).max() < 0.06


def test_a_path_far_from_all_walls_is_left_alone_and_floors_are_none() -> None:
    assert not list(past_walls(path(), slot(0.3), []))
    floor = Obstacle("floor", Pose.identity(), np.array([[0.4, 0.0, 0.0]]), np.full((1, 3), 0.05))
    assert not list(past_walls(path(), floor, []))


@pytest.mark.parametrize("turn", [0.7, -2.0])
def test_walls_turn_with_what_they_belong_to(turn: float) -> None:
    straight, turned = (
        next(past_walls(cutting_the_corner(angle), slot(0.0, angle), [])) for angle in (0.0, turn)
    )
    rotation = Pose.from_rpy([0.0, 0.0, 0.0], [0.0, 0.0, turn]).rotation[:2, :2]
    np.testing.assert_allclose(straight @ rotation.T, turned, atol=1e-3)
