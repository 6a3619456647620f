"""Tools on arms: composed from both, pointing where they should, taking hold only of what they may."""

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pybullet
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from cobot_lfd.errors import DescriptionError
from cobot_lfd.tool import tool_above
from robots import Arm, Kinematics, has_urdf, load_robot, robot_names, tool_names
from robots.body import connect
from robots.compose import compose, find_urdf
from robots.parts import Mount

pytestmark = pytest.mark.simulator

INSTALLED = [name for name in robot_names() if has_urdf(load_robot(name).urdf, load_robot(name).package)]
PANDA_WITH_CUP = load_robot("panda", "suction")


def test_at_least_the_arms_of_pybullet_data_are_installed() -> None:
    assert {"iiwa", "panda", "xarm6"} <= set(INSTALLED)


@pytest.mark.parametrize("tool", tool_names())
@pytest.mark.parametrize("robot", INSTALLED)
def test_every_tool_points_down_at_home_and_reaches_the_table(robot: str, tool: str) -> None:
    description = load_robot(robot, tool)
    with Kinematics(description) as kinematics:
        home = np.array(description.home)
        assert_allclose(kinematics.forward(home).rotation[:, 2], [0.0, 0.0, -1.0], atol=2e-3)
        goal = tool_above([0.5, 0.1], 0.02, 0.3)
        assert goal.angle_to(kinematics.forward(kinematics.inverse(goal, home))) < 1e-5  # [rad]


def test_a_mounted_tool_takes_the_place_of_what_hung_on_the_arm() -> None:
    urdf = find_urdf(PANDA_WITH_CUP.urdf, None)
    text = compose(urdf, PANDA_WITH_CUP.mount, PANDA_WITH_CUP.parts)
    links = {link.get("name") for link in ElementTree.fromstring(text).findall("link")}
    assert {"panda_link8", "mount", "cup", "tool"} <= links
    assert not links & {"panda_hand", "panda_leftfinger", "panda_grasptarget"}


def test_an_unknown_mounting_link_is_told() -> None:
    with pytest.raises(DescriptionError, match="no link named 'elbow', on which a tool could be mounted"):
        compose(find_urdf(PANDA_WITH_CUP.urdf, None), Mount(link="elbow"), PANDA_WITH_CUP.parts)


def test_a_missing_package_is_told_with_what_to_install() -> None:
    with pytest.raises(
        DescriptionError, match=r"'no-such-data', which is not installed; .*cobot-lfd\[robots\]"
    ):
        find_urdf("ur5.urdf", "no-such-data")
    assert not has_urdf("ur5.urdf", "no-such-data")


def test_an_unknown_tool_is_answered_with_the_known_ones() -> None:
    with pytest.raises(DescriptionError, match="no tool named 'saw'; choose one of: brush, gripper, suction"):
        load_robot("iiwa", "saw")


def cup_over_box(*, offset: float = 0.0, mass: float = 0.1) -> tuple[Any, Arm, int]:
    """An arm whose cup stands half a millimetre in the top of a box, ``offset`` [m] from its middle."""
    client = connect()
    client.setGravity(0.0, 0.0, -9.81)
    client.setTimeStep(0.002)
    shape = client.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[0.03, 0.03, 0.02])
    box = client.createMultiBody(mass, shape, basePosition=[0.5 + offset, 0.0, 0.02])
    floor = client.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[1.0, 1.0, 0.02])
    client.createMultiBody(0.0, floor, basePosition=[0.0, 0.0, -0.02])
    arm = Arm(client, PANDA_WITH_CUP)
    arm.body.place(joints_at([0.0395])[0])
    move(client, arm, [0.0395] * 20)
    return client, arm, box


def joints_at(heights: Sequence[float]) -> Array:
    """Joint positions with the cup at heights [m] over the box's place."""
    with Kinematics(PANDA_WITH_CUP) as kinematics:
        poses = [tool_above([0.5, 0.0], height, 0.0) for height in heights]
        return kinematics.follow(poses, np.array(PANDA_WITH_CUP.home))


def move(client: Any, arm: Arm, heights: Sequence[float]) -> None:
    """Bring the cup to heights [m], one after the other."""
    for joints in joints_at(heights):
        for _ in range(5):
            arm.follow(joints, np.zeros_like(joints))
            client.stepSimulation()


UP = np.linspace(0.0395, 0.15, 100).tolist()


def lifted(client: Any, box: int) -> bool:
    return bool(client.getBasePositionAndOrientation(box)[0][2] > 0.05)


def test_a_cup_lifts_what_it_sucks_and_lets_it_go() -> None:
    client, arm, box = cup_over_box()
    assert not arm.holds_something()
    arm.grip(0.0)
    move(client, arm, [0.0395] * 4)
    assert arm.holds_something()
    move(client, arm, UP)
    assert lifted(client, box)
    arm.grip(0.01)
    move(client, arm, [0.15] * 40)
    assert not arm.holds_something()
    assert not lifted(client, box)


def test_a_cup_does_not_lift_what_it_only_touches() -> None:
    client, arm, box = cup_over_box()
    move(client, arm, UP)
    assert not lifted(client, box)


def test_a_cup_does_not_seal_over_an_edge() -> None:
    client, arm, box = cup_over_box(offset=0.0385)
    arm.grip(0.0)
    move(client, arm, UP)
    assert not lifted(client, box)


def test_a_cup_does_not_lift_more_than_its_force() -> None:
    client, arm, box = cup_over_box(mass=6.0)
    arm.grip(0.0)
    move(client, arm, UP)
    assert not lifted(client, box)


def test_fingers_hold_by_friction_only_while_they_close() -> None:
    """Also a part that they touch already: contacts that last keep the friction with which they began."""
    client = connect()
    arm = Arm(client, load_robot("panda"))
    tip = arm.body.fingertips[0]
    place = client.getLinkState(arm.body.id, tip)[0]
    shape = client.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.01)
    part = client.createMultiBody(0.05, shape, basePosition=place)
    arm.grip(0.0)
    client.stepSimulation()
    closing = client.getDynamicsInfo(arm.body.id, tip)[1]
    assert closing > 1.0
    assert client.getContactPoints(bodyA=arm.body.id, bodyB=part)
    arm.grip(0.08)
    assert not client.getContactPoints(bodyA=arm.body.id, bodyB=part)
    assert client.getDynamicsInfo(arm.body.id, tip)[1] < 0.2 * closing
