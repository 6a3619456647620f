"""Inverse kinematics: what it finds is right, and what it cannot find it says."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn, equal_yaws, pointing_down, tool_above
from robots import JointLimitError, Kinematics, NotConvergedError, load_robot
from robots.body import RobotBody, connect

pytestmark = pytest.mark.simulator

PANDA = load_robot("panda")
HOME = np.array(PANDA.home)


@pytest.fixture(scope="module")
def kinematics() -> Iterator[Kinematics]:
    with Kinematics(PANDA) as kinematics:
        yield kinematics


def test_forward_undoes_inverse(kinematics: Kinematics) -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        point, height = rng.uniform([0.35, -0.3], [0.65, 0.3]), rng.uniform(0.02, 0.25)
        pose = tool_above(point, height, rng.uniform(-0.8, 0.8))
        reached = kinematics.forward(kinematics.inverse(pose, HOME))
        assert_allclose(reached.position, pose.position, atol=1.1e-6)  # [m]
        assert reached.angle_to(pose) < 3e-6  # [rad]


def test_a_straight_line_of_the_tool_is_a_smooth_line_of_the_joints(kinematics: Kinematics) -> None:
    poses = [tool_above([0.5, y], 0.2, 0.0) for y in np.linspace(-0.3, 0.3, 61)]
    joints = kinematics.follow(poses, kinematics.inverse(poses[0], HOME))
    steps = np.diff(joints, axis=0)
    assert np.abs(steps).max() < 0.05  # [rad] for 1 cm
    assert np.abs(np.diff(steps, axis=0)).max() < 5e-3  # [rad]


def test_the_solution_depends_on_the_pose_and_not_on_the_way_there(kinematics: Kinematics) -> None:
    """The null space pulls a redundant arm back to one posture for each pose."""
    pose = tool_above([0.5, 0.2], 0.2, 0.3)
    direct = kinematics.inverse(pose, HOME)
    detour = kinematics.inverse(pose, kinematics.inverse(tool_above([0.4, -0.3], 0.1, -0.5), HOME))
    assert_allclose(detour, direct, atol=0.02)  # [rad]


def test_a_pose_out_of_reach_is_told(kinematics: Kinematics) -> None:
    with pytest.raises(
        NotConvergedError, match=r"cannot reach \(1\.500, 0\.000, 0\.200\) m: .* no nearer than"
    ):
        kinematics.inverse(tool_above([1.5, 0.0], 0.2, 0.0), HOME)


def test_a_pose_beyond_a_joint_limit_is_told(kinematics: Kinematics) -> None:
    poses = [tool_above([0.5, 0.0], 0.2, yaw) for yaw in np.linspace(0.0, 4.0, 40)]
    with pytest.raises(JointLimitError, match=r"joint 7 would be at .* rad, but can take -2\.897 to 2\.897"):
        kinematics.follow(poses, HOME)


def test_the_jacobian_is_the_derivative_of_the_pose() -> None:
    """Central differences of the forward kinematics, joint by joint."""
    body, step = RobotBody(connect(), PANDA), 1e-3
    jacobian = body.jacobian(HOME)
    for i in range(len(HOME)):
        poses: list[Pose] = []
        for sign in (1, -1):
            moved = HOME.copy()
            moved[i] += sign * step
            body.place(moved)
            poses.append(body.tool_pose())
        assert_allclose((poses[0].position - poses[1].position) / (2 * step), jacobian[:3, i], atol=1e-4)


def test_gravity_torques_hold_the_arm_still() -> None:
    client = connect()
    client.setGravity(0.0, 0.0, -9.81)
    client.setTimeStep(0.002)
    body = RobotBody(client, PANDA)
    body.place(HOME)
    for _ in range(500):
        positions, _ = body.joint_states()
        for joint, torque in zip(body.joints, body.gravity_torques(positions), strict=True):
            client.setJointMotorControl2(body.id, joint, client.VELOCITY_CONTROL, force=0.0)
            client.setJointMotorControl2(body.id, joint, client.TORQUE_CONTROL, force=torque)
        client.stepSimulation()
    assert_allclose(body.joint_states()[0], HOME, atol=5e-3)  # [rad] after one second


@pytest.mark.parametrize("yaw", [-1.0, 0.0, 0.7])
def test_the_tool_points_down_and_along_its_yaw(yaw: float) -> None:
    rotation = pointing_down(yaw)
    assert_allclose(rotation @ [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], atol=1e-12)
    assert_allclose(rotation @ [1.0, 0.0, 0.0], [np.cos(yaw), np.sin(yaw), 0.0], atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@pytest.mark.parametrize("turns", [1, 2, 3, 4])
def test_the_yaws_that_do_equally_well_are_evenly_spread_and_the_nearest_comes_first(turns: int) -> None:
    for direction in np.linspace(-3.0, 3.0, 13):
        yaws = np.array(equal_yaws(direction, turns, preferred=0.2))
        assert len(yaws) == turns
        assert abs(yaws[0] - 0.2) <= np.pi / turns + 1e-9
        assert_allclose(np.exp(1j * turns * (yaws - direction)), 1.0, atol=1e-9)
        assert_allclose(np.diff(np.sort(yaws)), 2 * np.pi / turns)


def test_a_turn_goes_smoothly_from_its_start_to_its_end_and_is_done_on_the_way() -> None:
    path = np.column_stack([np.linspace(0.0, 1.0, 1001), np.zeros(1001)])
    yaws = ToolTurn(0.3, -1.2, 0.2, 0.7).along(path)
    assert_allclose(yaws[:200], 0.3)
    assert_allclose(yaws[701:], -1.2)
    assert (np.diff(yaws) <= 0.0).all()
    assert np.abs(np.diff(yaws, 2)).max() < 1e-4
    assert_allclose(ToolTurn.none(0.4).along(path), 0.4)
