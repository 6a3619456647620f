"""Rigid motions: they form a group and agree with scipy's rotations."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from cobot_lfd.pose import Pose

GENERATOR = np.random.default_rng(0)


def random_pose() -> Pose:
    return Pose(GENERATOR.normal(size=3), Rotation.random(rng=GENERATOR).as_matrix())


def assert_same(a: Pose, b: Pose) -> None:
    assert_allclose(a.position, b.position, atol=1e-12)
    assert_allclose(a.rotation, b.rotation, atol=1e-12)


def test_poses_form_a_group() -> None:
    a, b, c = random_pose(), random_pose(), random_pose()
    assert_same((a @ b) @ c, a @ (b @ c))
    assert_same(a @ a.inverse(), Pose.identity())
    assert_same(Pose.identity() @ a, a)
    assert_same((a @ b).inverse(), b.inverse() @ a.inverse())


def test_a_chain_of_poses_moves_points_one_after_the_other() -> None:
    a, b, points = random_pose(), random_pose(), GENERATOR.normal(size=(7, 3))
    assert_allclose((a @ b).apply(points), a.apply(b.apply(points)), atol=1e-12)


def test_a_pose_keeps_distances() -> None:
    points = GENERATOR.normal(size=(2, 3))
    moved = random_pose().apply(points)
    assert np.linalg.norm(moved[0] - moved[1]) == pytest.approx(np.linalg.norm(points[0] - points[1]))


def test_quaternions_go_there_and_back_in_the_order_xyzw() -> None:
    pose = random_pose()
    assert_same(Pose.from_quaternion(pose.position, pose.quaternion), pose)
    assert_allclose(Pose.from_rpy(np.zeros(3), [0, 0, np.pi / 2]).quaternion, [0, 0, 0.5**0.5, 0.5**0.5])


def test_roll_pitch_yaw_turn_about_fixed_axes() -> None:
    """As in a URDF: first about x, then about y, then about z."""
    roll, pitch, yaw = 0.3, -0.7, 1.1
    one_by_one = (
        Rotation.from_rotvec(angle * axis)
        for angle, axis in zip((yaw, pitch, roll), np.eye(3)[::-1], strict=True)
    )
    expected = np.linalg.multi_dot([turn.as_matrix() for turn in one_by_one])
    assert_allclose(Pose.from_rpy(np.zeros(3), [roll, pitch, yaw]).rotation, expected, atol=1e-12)


def test_the_angle_between_poses_is_the_angle_of_the_turn() -> None:
    pose = random_pose()
    turned = pose @ Pose.from_rpy(np.ones(3), [0.0, 0.4, 0.0])
    assert pose.angle_to(turned) == pytest.approx(0.4)


@pytest.mark.parametrize("rotation", [2 * np.eye(3), np.diag([1.0, 1.0, -1.0])])
def test_what_is_no_rotation_is_told(rotation: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"rotation is no rotation matrix: its rows must be orthonormal"):
        Pose(np.zeros(3), rotation)
