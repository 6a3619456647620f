"""The guided hand: it follows the pointer smoothly, with limited force, and rests when let go."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.app.recording.carry import trimmed_carry
from cobot_lfd.app.recording.guided_hand import GuidedHand
from cobot_lfd.app.studio.pointer import Grab, on_plane
from cobot_lfd.arrays import Array
from cobot_lfd.pose import Pose
from cobot_lfd.tool import pointing_down
from robots import ArmState
from scenes import load_scene

TASK = load_scene("pick_and_place").task
TICK = 0.002  # [s]


class Puppet:
    """A point mass with the tool's rotation, which the hand moves."""

    def __init__(self, hand: GuidedHand, position: tuple[float, float, float]) -> None:
        self.hand = hand
        self.position, self.velocity = np.array(position), np.zeros(3)
        self.rotation, self.opening = pointing_down(0.0), 0.08
        self.forces: list[Array] = []
        self.carried = False

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / TICK)):
            zeros = np.zeros(7)
            tool = Pose(self.position, self.rotation)
            state = ArmState(zeros, zeros, zeros, tool, self.velocity, np.zeros(3), self.opening)
            action = self.hand.act(state)
            assert action is not None
            self.carried = action.carrying
            self.forces.append(action.force)
            self.velocity = self.velocity + TICK * (action.force - 10.0 * self.velocity) / 3.0
            self.position = self.position + TICK * self.velocity
            self.rotation = _turned(self.rotation, action.torque)


def _turned(rotation: Array, torque: Array) -> Array:
    """A tool without inertia, turned by a torque."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_rotvec(np.clip(TICK * torque / 0.5, -0.1, 0.1))
    return np.asarray((turn * Rotation.from_matrix(rotation)).as_matrix())


@pytest.fixture
def puppet() -> Puppet:
    return Puppet(GuidedHand(TASK, 0.08, TICK), (0.48, 0.0, 0.3))


def test_with_the_guide_the_tool_comes_to_the_carry_height_and_stays_there(puppet: Puppet) -> None:
    puppet.run(2.0)
    assert_allclose(puppet.position, [0.48, 0.0, TASK.carry_height], atol=2e-3)
    puppet.hand.reach(np.array([0.6, 0.2, 0.9]))
    puppet.run(2.0)
    assert_allclose(puppet.position, [0.6, 0.2, TASK.carry_height], atol=2e-3)


def test_without_the_guide_the_tool_goes_where_the_pointer_is(puppet: Puppet) -> None:
    puppet.hand.guide = False
    puppet.hand.reach(np.array([0.5, 0.1, 0.35]))
    puppet.run(2.0)
    assert_allclose(puppet.position, [0.5, 0.1, 0.35], atol=2e-3)


def test_the_force_is_limited_however_far_the_pointer_is(puppet: Puppet) -> None:
    puppet.hand.reach(np.array([5.0, 5.0, 0.3]))
    puppet.run(1.0)
    assert np.linalg.norm(puppet.forces, axis=1).max() <= 40.0 + 1e-9  # [N]


def test_the_force_does_not_jump_with_the_pointer(puppet: Puppet) -> None:
    """Pointer events come in steps; a step of 5 cm changes the force by little from tick to tick."""
    puppet.run(2.0)
    puppet.forces.clear()
    puppet.hand.reach(np.array([0.53, 0.0, 0.2]))
    puppet.run(0.5)
    assert np.linalg.norm(np.diff(puppet.forces, axis=0), axis=1).max() < 3.0  # [N]


def test_let_go_on_the_way_the_arm_rests_where_it_is(puppet: Puppet) -> None:
    puppet.run(2.0)
    puppet.hand.reach(np.array([0.7, 0.4, 0.2]))
    puppet.run(0.4)
    puppet.hand.let_go()
    puppet.run(0.05)
    where = puppet.position.copy()
    puppet.run(2.0)
    assert np.linalg.norm(puppet.position - where) < 0.08  # [m]; it brakes
    assert np.linalg.norm(puppet.velocity) < 1e-3  # [m/s]
    assert np.linalg.norm(puppet.forces[-1]) < 0.5  # [N]


def test_lower_goes_to_the_part_and_with_a_part_to_where_it_is_let_go(puppet: Puppet) -> None:
    puppet.hand.lower()
    puppet.run(3.0)
    assert_allclose(puppet.position[2], TASK.grasp_height, atol=2e-3)
    puppet.hand.close_or_open()
    puppet.opening = 0.04
    puppet.hand.lift()
    puppet.run(3.0)
    assert_allclose(puppet.position[2], TASK.carry_height, atol=2e-3)
    assert puppet.carried
    puppet.hand.lower()
    puppet.run(3.0)
    assert_allclose(puppet.position[2], TASK.release_height, atol=2e-3)
    assert not puppet.carried


def test_an_empty_gripper_carries_nothing(puppet: Puppet) -> None:
    puppet.hand.close_or_open()
    puppet.opening = 0.0
    puppet.run(2.0)
    assert not puppet.carried


def test_the_tool_turns_and_keeps_pointing_down(puppet: Puppet) -> None:
    puppet.hand.turn(0.4)
    puppet.hand.turn(0.3)
    puppet.run(3.0)
    assert_allclose(puppet.rotation, pointing_down(0.7), atol=0.02)


def test_a_pointer_on_a_plane_is_where_its_ray_meets_the_plane() -> None:
    camera, place = np.array([1.4, -0.5, 1.0]), np.array([0.5, 0.1, 0.2])
    through = camera + 0.6 * (place - camera)
    met = on_plane(camera, through, 0.2)
    assert met is not None
    assert_allclose(met, place)
    assert on_plane(camera, camera + np.array([1.0, 0.0, 0.0]), 0.2) is None
    assert on_plane(camera, camera + np.array([0.0, 0.0, 1.0]), 0.2) is None


def test_a_grab_moves_the_tool_by_what_the_pointer_moves() -> None:
    camera, tool, grabbed = np.array([1.4, -0.5, 1.0]), np.array([0.5, 0.0, 0.2]), np.array([0.53, 0.0, 0.23])
    grab = Grab(1, grabbed, tool)
    assert_allclose(grab.goal(camera, grabbed, guide=True), tool, atol=1e-12)
    moved = grabbed + np.array([0.1, -0.2, 0.0])
    assert_allclose(grab.goal(camera, moved, guide=True), tool + np.array([0.1, -0.2, 0.0]), atol=1e-12)
    lifted = grabbed + np.array([0.0, 0.0, 0.1])
    assert_allclose(grab.goal(camera, lifted, guide=False), tool + np.array([0.0, 0.0, 0.1]))


def test_a_carry_is_trimmed_to_where_the_tool_moves() -> None:
    still, move = np.zeros((50, 3)), np.linspace([0.0, 0.0, 0.0], [0.3, 0.0, 0.0], 100)
    positions = np.concatenate([still, move, still + np.array([0.3, 0.0, 0.0])])
    kept = np.flatnonzero(trimmed_carry(np.ones(200, dtype=np.bool_), positions))
    assert 48 <= kept[0] <= 52
    assert 147 <= kept[-1] <= 151
    assert (np.diff(kept) == 1).all()


def test_the_longest_of_two_carries_is_kept() -> None:
    positions = np.concatenate(
        [np.linspace([0, 0, 0], [0.1, 0, 0], 100), np.linspace([0.1, 0, 0], [0.5, 0, 0], 100)]
    )
    carrying = np.ones(200, dtype=np.bool_)
    carrying[95:105] = False
    assert np.flatnonzero(trimmed_carry(carrying, positions))[0] >= 105


def test_what_never_moved_is_no_carry() -> None:
    assert not trimmed_carry(np.ones(30, dtype=np.bool_), np.zeros((30, 3))).any()
    assert not trimmed_carry(np.zeros(30, dtype=np.bool_), np.zeros((30, 3))).any()
