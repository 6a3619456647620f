"""A simulation that is emptied and used again gives the same bits as a new one."""

import hashlib
from typing import Any

import numpy as np
import pytest

from robots import Arm, load_robot
from scenes import World, connect, load_scene

pytestmark = pytest.mark.simulator

N_STEPS = 150
CASES = [("pick_and_place", "panda", 5), ("ball_in_hole", "panda", 6), ("pick_and_place", "iiwa", 7)]


def fingerprint(scene: str, robot: str, seed: int, client: Any = None) -> str:
    """Checksum of a picture, and of every pose and joint while an arm sweeps over the table."""
    described = load_scene(scene)
    arm_described = load_robot(robot, described.task.tool)
    parked, home = np.array(arm_described.parked), np.array(arm_described.home)
    digest = hashlib.sha256()
    with World(described, seed, client=client) as world:
        arm = Arm(world.client, arm_described, visible=False)
        digest.update(world.take_picture().tobytes())
        for i in range(N_STEPS):
            arm.follow(parked + (home - parked) * i / N_STEPS, np.zeros_like(home))
            arm.grip(0.0)
            world.step()
            digest.update(np.concatenate(arm.body.joint_states()).tobytes())
            for name in world.bodies:
                pose = world.true_centre(name)
                digest.update(pose.position.tobytes() + pose.rotation.tobytes())
    return digest.hexdigest()


def test_a_simulation_that_is_emptied_gives_the_bits_of_a_new_one() -> None:
    client = connect()
    anew = [fingerprint(*case) for case in CASES]
    again = [fingerprint(*case, client=client) for case in [*CASES, *CASES]]
    assert again == [*anew, *anew]
    assert len(set(anew)) == len(CASES)


def test_a_lent_simulation_goes_on_after_its_world() -> None:
    client = connect()
    with World(load_scene("pick_and_place"), 0, client=client):
        pass
    assert client.isConnected()
