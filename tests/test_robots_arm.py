"""The arm in the simulation: it gives way to a hand, and follows what it is told."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from robots import Arm, load_robot
from robots.body import connect

pytestmark = pytest.mark.simulator

PANDA = load_robot("panda")
STEP = 0.002  # [s]
NOTHING = np.zeros(3)


def arm_alone() -> tuple[Any, Arm]:
    client = connect()
    client.setGravity(0.0, 0.0, -9.81)
    client.setTimeStep(STEP)
    return client, Arm(client, PANDA)


def lead(client: Any, arm: Arm, force: Any, n_steps: int) -> None:
    for _ in range(n_steps):
        arm.lead(np.asarray(force, dtype=np.float64), NOTHING)
        client.stepSimulation()


def test_an_arm_that_nobody_pulls_floats_where_it_is() -> None:
    client, arm = arm_alone()
    before = arm.tool_position()
    lead(client, arm, NOTHING, 500)
    assert_allclose(arm.tool_position(), before, atol=3e-3)  # [m] after one second


@pytest.mark.parametrize("direction", np.vstack([np.eye(3), -np.eye(3)]))
def test_an_arm_gives_way_in_the_direction_of_the_pull(direction: Any) -> None:
    client, arm = arm_alone()
    before = arm.tool_position()
    lead(client, arm, 10.0 * direction, 100)
    moved = arm.tool_position() - before
    assert moved @ direction > 0.005  # [m]
    assert moved @ direction > 0.5 * np.linalg.norm(moved)


def test_an_arm_that_follows_is_where_it_is_told_to_be() -> None:
    client, arm = arm_alone()
    start, turn = np.array(PANDA.parked), 0.3 * np.ones(7)
    for t in np.arange(STEP, 1.0, STEP):
        share, rate = 0.5 - 0.5 * np.cos(np.pi * t), 0.5 * np.pi * np.sin(np.pi * t)
        arm.follow(start + share * turn, rate * turn)
        client.stepSimulation()
        assert_allclose(arm.state().positions, start + share * turn, atol=1e-3)  # [rad]


def test_closed_fingers_hold_something_only_where_there_is_something() -> None:
    client, arm = arm_alone()
    arm.grip(0.0)
    for _ in range(400):
        arm.hold()
        client.stepSimulation()
    assert not arm.holds_something()
    assert arm.opening() == pytest.approx(0.0, abs=1e-3)


def test_the_fingers_open_as_far_as_they_are_told() -> None:
    client, arm = arm_alone()
    for opening in (0.02, 0.06):
        arm.grip(opening)
        for _ in range(600):
            client.stepSimulation()
        assert arm.opening() == pytest.approx(opening, abs=1e-3)
        assert not arm.holds_something()
