"""Compliance: stiffness follows the covariance, and the arm behaves like the spring that it is told to be."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.app.compliance import Compliance, StiffnessField
from cobot_lfd.learning.path import GeneratedPath
from robots import Arm, load_robot
from robots.body import connect
from robots.impedance import posture_torques, tool_wrench

PANDA = load_robot("panda")
STEP = 0.002  # [s]
HOME = np.array(PANDA.home)


def test_the_force_moves_the_tool_by_one_standard_deviation_in_every_direction() -> None:
    rng = np.random.default_rng(0)
    root = rng.normal(size=(20, 2, 2)) * 0.01
    covariance = root @ np.swapaxes(root, 1, 2) + 1e-6 * np.eye(2)
    stiffness = Compliance(force=4.0, softest=1e-6, stiffest=1e9).stiffness(covariance)
    assert_allclose(
        stiffness @ covariance @ stiffness, np.broadcast_to(16.0 * np.eye(2), (20, 2, 2)), atol=1e-6
    )


def test_stiffness_keeps_its_bounds_and_turns_with_the_covariance() -> None:
    compliance = Compliance(force=5.0, softest=200.0, stiffest=4000.0)
    thin = np.diag([1e-10, 1.0])
    assert_allclose(compliance.stiffness(thin), np.diag([4000.0, 200.0]))
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    covariance = np.diag([1e-5, 1e-4])
    assert_allclose(
        compliance.stiffness(turn @ covariance @ turn.T), turn @ compliance.stiffness(covariance) @ turn.T
    )


def test_a_place_has_the_stiffness_of_the_nearest_point_of_the_path() -> None:
    mean = np.column_stack([np.linspace(0.0, 1.0, 11), np.zeros(11)])
    covariance = np.linspace(1e-5, 1e-3, 11)[:, None, None] * np.eye(2)
    field = StiffnessField(Compliance(), GeneratedPath(mean, covariance, np.linspace(0.0, 1.0, 11)))
    assert_allclose(field(np.array([0.31, 0.2])), Compliance().stiffness(covariance)[3])


def test_torques_that_hold_the_posture_do_not_move_the_tool() -> None:
    jacobian = np.random.default_rng(1).normal(size=(6, 7))
    torques = posture_torques(jacobian, np.arange(7.0), np.zeros(7))
    assert np.linalg.norm(torques) > 0.1
    assert_allclose(jacobian @ torques, 0.0, atol=1e-9)


def test_the_wrench_is_that_of_a_spring() -> None:
    stiffness = np.array([[900.0, 200.0], [200.0, 400.0]])
    wrench = tool_wrench(stiffness, np.array([0.01, -0.02, 0, 0, 0, 0]), np.zeros(6))
    assert_allclose(wrench[:2], stiffness @ [0.01, -0.02])
    assert_allclose(wrench[2:], 0.0)


def pushed(stiffness: float, force: float) -> Any:
    """How far the tool has moved after a second's push along y [m], shape (3,)."""
    client = connect()
    client.setGravity(0.0, 0.0, -9.81)
    client.setTimeStep(STEP)
    arm = Arm(client, PANDA)
    arm.body.place(HOME)
    before = arm.tool_position()
    for _ in range(500):
        arm.comply(HOME, np.zeros(7), np.zeros(7), stiffness * np.eye(2))
        place = arm.tool_position().tolist()
        client.applyExternalForce(arm.body.id, arm.body.tool, [0.0, force, 0.0], place, client.WORLD_FRAME)
        client.stepSimulation()
    return arm.tool_position() - before


@pytest.mark.simulator
@pytest.mark.parametrize("stiffness", [300.0, 2000.0])
def test_an_arm_gives_way_as_much_as_its_spring(stiffness: float) -> None:
    assert_allclose(pushed(stiffness, 6.0), [0.0, 6.0 / stiffness, 0.0], atol=1.5e-3)  # [m]


@pytest.mark.simulator
def test_an_arm_that_nobody_pushes_stays() -> None:
    assert_allclose(pushed(500.0, 0.0), 0.0, atol=5e-4)  # [m]
