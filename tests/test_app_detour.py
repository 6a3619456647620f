"""Detours: out of the way of things, as little as needed, least where the demonstrations agree."""

import numpy as np
import pytest

from cobot_lfd.app.detour import detours
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
