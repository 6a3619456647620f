"""Replay: the recorded motion happens again, and how far it deviates is measured, not assumed."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.replay import gripper_orders, replay
from cobot_lfd.app.demonstrations.store import list_episodes, load_episode
from cobot_lfd.errors import DataError
from tests.app_examples import episode


@pytest.fixture(scope="module")
def recorded(demonstrations_folder: Path) -> RecordedEpisode:
    return load_episode(list_episodes(demonstrations_folder)[0])


@pytest.mark.simulator
def test_the_joint_states_repeat_the_demonstration(recorded: RecordedEpisode) -> None:
    result = replay(recorded, "joints")
    assert result.verdict.succeeded, result.verdict.sentence
    assert result.worst < 0.001  # [m]


@pytest.mark.simulator
def test_the_wrenches_move_the_arm_much_as_they_did(recorded: RecordedEpisode) -> None:
    """Applied without looking, they drift, but far less than the path is long."""
    result = replay(recorded, "wrenches")
    assert 0.0 < result.mean < 0.03  # [m]
    assert result.mean <= result.worst


@pytest.mark.simulator
def test_the_deviation_is_measured_against_what_was_recorded(recorded: RecordedEpisode) -> None:
    elsewhere = replace(recorded, tool_positions=recorded.tool_positions + np.array([0.0, 0.0, 0.05]))
    assert replay(elsewhere, "joints").mean == pytest.approx(0.05, abs=0.002)  # [m]


@pytest.mark.simulator
def test_every_step_is_observed(recorded: RecordedEpisode) -> None:
    steps: list[None] = []
    short = {
        name: getattr(recorded, name)[:20]
        for name in RecordedEpisode.__dataclass_fields__
        if name not in ("scene", "robot", "seed", "verdict", "picture", "detections")
    }
    replay(replace(recorded, **short), "joints", observer=lambda: steps.append(None))
    assert len(steps) >= 20 * 5


def test_an_order_to_the_gripper_is_read_from_its_encoder() -> None:
    openings = np.concatenate(
        [np.full(5, 0.08), np.linspace(0.08, 0.04, 10), np.full(9, 0.04), np.linspace(0.04, 0.08, 10)]
    )
    orders = gripper_orders(openings, 0.08)
    assert_array_equal(orders[[0, 5, 8, 20, 23, 30]], [0.08, 0.08, 0.0, 0.0, 0.0, 0.08])
    assert_array_equal(np.unique(orders), [0.0, 0.08])


def test_a_gripper_that_starts_closed_is_told_so() -> None:
    assert_array_equal(gripper_orders(np.full(3, 0.04), 0.08), 0.0)


def test_an_episode_without_joint_states_cannot_be_replayed() -> None:
    nothing = np.zeros((50, 0))
    imported = replace(episode(), joint_positions=nothing, joint_velocities=nothing, joint_torques=nothing)
    with pytest.raises(DataError, match="has no joint states; it cannot be replayed"):
        replay(imported, "joints")
