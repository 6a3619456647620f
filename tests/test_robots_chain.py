"""The chain of an arm's joints: its poses are PyBullet's, its Jacobians are the poses' derivatives."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from cobot_lfd.arrays import Array
from cobot_lfd.tool import tool_above
from robots import Kinematics, RobotDescription, has_urdf, load_robot, robot_names
from robots.body import RobotBody, connect
from robots.chain import Chain

pytestmark = pytest.mark.simulator

DESCRIBED = {name: load_robot(name) for name in robot_names()}
ROBOTS = [name for name, robot in DESCRIBED.items() if has_urdf(robot.urdf, robot.package)]
STEP = 1e-5  # [rad] of central differences


def postures(robot: RobotDescription, n: int) -> Array:
    limits = robot.joint_limits
    return np.random.default_rng(0).uniform(
        limits.position_lower, limits.position_upper, (n, limits.n_joints)
    )


@pytest.mark.parametrize("name", ROBOTS)
def test_its_poses_are_those_of_the_simulator(name: str) -> None:
    """To the 3e-7 by which PyBullet's own rotations are none: their quaternions have that length's error."""
    robot = DESCRIBED[name]
    body = RobotBody(connect(), robot)
    chosen = postures(robot, 20)
    reach = Chain.of(body).reach(chosen)
    for posture, position, rotation in zip(chosen, reach.positions, reach.rotations, strict=True):
        body.place(posture)
        assert_allclose(position, body.tool_pose().position, atol=3e-7)  # [m]
        assert_allclose(rotation, body.tool_pose().rotation, atol=6e-7)


@pytest.mark.parametrize("name", ROBOTS)
def test_its_jacobians_are_the_derivatives_of_its_poses(name: str) -> None:
    robot = DESCRIBED[name]
    chain = Chain.of(RobotBody(connect(), robot))
    chosen = postures(robot, 10)
    jacobians = chain.reach(chosen).jacobians
    for i, moved in enumerate(STEP * np.eye(chosen.shape[1])):
        after, before = chain.reach(chosen + moved), chain.reach(chosen - moved)
        assert_allclose((after.positions - before.positions) / (2 * STEP), jacobians[:, :3, i], atol=1e-9)
        turns = Rotation.from_matrix(after.rotations @ np.swapaxes(before.rotations, 1, 2)).as_rotvec()
        assert_allclose(turns / (2 * STEP), jacobians[:, 3:, i], atol=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_path_that_is_found_at_once_is_the_one_that_is_found_pose_by_pose(name: str) -> None:
    robot = DESCRIBED[name]
    poses = [tool_above([0.4 + 0.1 * s, 0.25 * np.sin(3 * s)], 0.15, 0.3 * s) for s in np.linspace(0, 1, 60)]
    with Kinematics(robot) as kinematics:
        start = kinematics.inverse(poses[0], np.array(robot.home))
        together, one_by_one, last = kinematics.follow(poses, start), [], start
        for pose in poses:
            last = kinematics.inverse(pose, last)
            one_by_one.append(last)
    assert_allclose(together, one_by_one, atol=2e-4)  # [rad]; where a step is smaller it counts as settled


def test_its_poses_do_not_depend_on_what_else_is_asked() -> None:
    """Bit by bit: a result must not change with the number of poses that are found together."""
    robot = load_robot("panda")
    chain, chosen = Chain.of(RobotBody(connect(), robot)), postures(robot, 33)
    together = chain.reach(chosen)
    for i in (0, 16, 32):
        alone = chain.reach(chosen[i : i + 1])
        assert alone.positions.tobytes() == together.positions[i : i + 1].tobytes()
        assert alone.jacobians.tobytes() == together.jacobians[i : i + 1].tobytes()
