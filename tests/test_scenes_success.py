"""Criteria of success beyond lying in a container: regions, tilt, forces, passages."""

from typing import Any

import numpy as np
import pytest

from cobot_lfd.outcome import Outcome
from cobot_lfd.pose import Pose
from scenes import World, check_success, load_scene

pytestmark = pytest.mark.simulator

PEG, HANDOVER, INSPECTION = load_scene("peg_in_slot"), load_scene("handover"), load_scene("inspection")


def put(world: World, name: str, frame: str, position: Any, rpy: Any = (0.0, 0.0, 0.0)) -> None:
    """Put an object's centre of mass at a pose in another's frame."""
    pose = world.true_poses()[frame] @ Pose.from_rpy(position, rpy)
    world.client.resetBasePositionAndOrientation(
        world.bodies[name], pose.position.tolist(), pose.quaternion.tolist()
    )
    world.client.resetBaseVelocity(world.bodies[name], [0.0] * 3, [0.0] * 3)


def settle(world: World, n_steps: int = 150) -> None:
    for _ in range(n_steps):
        world.step()


def test_a_peg_that_came_along_its_slot_and_stands_in_it_is_success() -> None:
    with World(PEG, 0) as world:
        put(world, "peg", "slot", [-0.05, 0.0, 0.035])
        world.step()
        put(world, "peg", "slot", [0.0, 0.0, 0.03])
        settle(world)
        assert check_success(world).outcome is Outcome.SUCCESS


def test_a_peg_that_came_into_its_slot_from_above_is_no_success() -> None:
    with World(PEG, 0) as world:
        put(world, "peg", "slot", [0.0, 0.0, 0.03])
        settle(world)
        verdict = check_success(world)
    assert verdict.outcome is Outcome.NOT_PLACED
    assert verdict.detail == "the peg did not pass the slot"


def test_a_peg_before_its_slot_is_told_with_its_distance() -> None:
    with World(PEG, 0) as world:
        put(world, "peg", "slot", [-0.12, 0.0, 0.03])
        settle(world)
        verdict = check_success(world)
    assert verdict.outcome is Outcome.NOT_PLACED
    assert "100." in verdict.detail or "99." in verdict.detail  # [mm] from a region that begins at -20 mm


def test_a_peg_that_lies_in_its_slot_has_tipped_over() -> None:
    with World(PEG, 0) as world:
        put(world, "peg", "slot", [-0.005, 0.0, 0.025], (0.0, np.pi / 2, 0.0))
        settle(world)
        verdict = check_success(world)
    assert verdict.outcome is Outcome.NOT_PLACED
    assert "tilted by 90 degrees" in verdict.detail


def drop_into_hand(height: float) -> Outcome:
    """What becomes of a board that came in at the palm's open side and is let go at a height [m]."""
    with World(HANDOVER, 0) as world:
        put(world, "board", "hand", [-0.08, 0.0, 0.03])
        world.step()
        put(world, "board", "hand", [0.0, 0.0, height])
        settle(world, 400)
        return check_success(world).outcome


def test_a_board_laid_into_the_hand_is_success_and_one_thrown_into_it_hurts() -> None:
    assert drop_into_hand(0.017) is Outcome.SUCCESS
    assert drop_into_hand(0.40) is Outcome.HARD_CONTACT


def test_a_cube_that_was_not_carried_over_the_scanner_is_no_success() -> None:
    with World(INSPECTION, 0) as world:
        put(world, "cube", "container", [0.0, 0.0, 0.024])
        settle(world)
        verdict = check_success(world)
    assert verdict.outcome is Outcome.NOT_PLACED
    assert verdict.detail == "the cube did not pass the scanner"


def test_a_cube_that_was_carried_over_the_scanner_is_success() -> None:
    with World(INSPECTION, 0) as world:
        put(world, "cube", "scanner", [0.0, 0.0, 0.14])
        world.step()
        put(world, "cube", "container", [0.0, 0.0, 0.024])
        settle(world)
        assert check_success(world).outcome is Outcome.SUCCESS


def test_the_force_of_what_rests_is_its_weight() -> None:
    with World(HANDOVER, 0) as world:
        put(world, "board", "hand", [0.0, 0.0, 0.0165])
        settle(world, 300)
        world.watch.largest_force = 0.0
        settle(world, 20)
        mass = HANDOVER.objects["board"].mass
        assert world.watch.largest_force == pytest.approx(9.81 * mass, rel=0.3)
