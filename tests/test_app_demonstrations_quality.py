"""Quality: smoothness measures what its source says, and the warnings name what is wrong."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.quality import assess, spectral_arc_length
from cobot_lfd.arrays import Array
from tests.app_examples import detection, episode


def minimum_jerk_speed(duration: float, size: float = 1.0) -> tuple[Array, Array]:
    """The bell-shaped speed of a reach, and its times."""
    times = np.arange(0.0, duration, 0.005, dtype=np.float64)
    u = times / duration
    return size * 30 * u**2 * (1 - u) ** 2 / duration, times


def carried_along(path: Array) -> RecordedEpisode:
    """An episode that carries the part along a path in the plane, seen from a cube and a container."""
    n = len(path)
    rows: dict[str, Any] = {name: np.zeros((n, 3)) for name in ("hand_forces", "hand_torques")}
    rows |= {
        name: np.tile([0.0, -0.2, 0.0, -2.3, 0.0, 2.1, 0.785], (n, 1))
        for name in ("joint_positions", "joint_velocities", "joint_torques")
    }
    return replace(
        episode(),
        times=np.asarray(0.01 * np.arange(n), dtype=np.float64),
        tool_positions=np.column_stack([path, np.full(n, 0.2)]),
        tool_quaternions=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
        gripper_openings=np.zeros(n),
        gripper_orders=np.zeros(n),
        carrying=np.ones(n, dtype=np.bool_),
        detections=(detection("cube", x=0.5, y=0.0), detection("container", x=0.5, y=0.3)),
        **rows,
    )


STRAIGHT = np.column_stack([np.full(200, 0.5), np.linspace(0.0, 0.3, 200)])


@pytest.mark.parametrize("duration", [0.8, 2.0, 4.0])
def test_a_minimum_jerk_reach_is_as_smooth_as_in_the_source(duration: float) -> None:
    """Balasubramanian et al. (2015) give about -1.4 for it, whatever its duration and size."""
    smoothness = spectral_arc_length(*minimum_jerk_speed(duration, size=duration))
    assert smoothness == pytest.approx(-1.41, abs=0.03)


def test_a_tremor_and_a_second_attempt_are_less_smooth() -> None:
    speed, times = minimum_jerk_speed(2.0)
    smooth = spectral_arc_length(speed, times)
    assert spectral_arc_length(speed + 0.2 * np.sin(2 * np.pi * 5 * times) ** 2, times) < smooth - 0.1
    twice = np.concatenate([speed, speed])
    assert (
        spectral_arc_length(twice, np.asarray(0.005 * np.arange(len(twice)), dtype=np.float64)) < smooth - 0.5
    )


def test_a_good_demonstration_has_no_warning() -> None:
    quality = assess(carried_along(STRAIGHT))
    assert quality.warnings == ()
    assert_allclose(quality.carried, 0.3)  # [m]
    assert_allclose(quality.duration, 1.99)  # [s]


def test_a_carry_that_ends_elsewhere_is_told() -> None:
    assert assess(carried_along(STRAIGHT * [1.0, 0.5])).warnings == ("ends 15 cm from the container",)
    assert "starts 4 cm from the cube" in assess(carried_along(STRAIGHT + np.array([0.04, 0.0]))).warnings


def test_a_joint_at_its_limit_is_told() -> None:
    joints = np.tile([0.0, -0.2, 0.0, -0.08, 0.0, 2.1, 0.785], (200, 1))
    assert assess(replace(carried_along(STRAIGHT), joint_positions=joints)).warnings == (
        "joint 4 at its limit",
    )


def test_a_stop_and_a_change_of_height_are_told() -> None:
    stopped = np.concatenate([STRAIGHT[:100], np.repeat(STRAIGHT[99:100], 120, axis=0), STRAIGHT[100:]])
    assert assess(carried_along(stopped)).warnings == ("stands still for 1.2 s on the way",)
    lifted = np.column_stack([STRAIGHT, np.linspace(0.1, 0.2, 200)])
    assert assess(replace(carried_along(STRAIGHT), tool_positions=lifted)).warnings == (
        "its height varies by 10 cm",
    )


def test_an_episode_without_a_carry_is_told() -> None:
    quality = assess(replace(carried_along(STRAIGHT), carrying=np.zeros(200, dtype=np.bool_)))
    assert quality.warnings == ("nothing was carried",)
    assert quality.smoothness is None


def test_an_object_that_the_camera_missed_is_told() -> None:
    seen = (detection("cube", x=0.5, y=0.0),)
    assert assess(replace(carried_along(STRAIGHT), detections=seen)).warnings == (
        "the camera did not see the container",
    )
