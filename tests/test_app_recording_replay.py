"""Replay: the recorded motion happens again, and how far it deviates is measured, not assumed."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.pulls import Pulls
from cobot_lfd.app.demonstrations.store import list_episodes, load_episode
from cobot_lfd.app.recording.replay import replay
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
def test_the_wrenches_repeat_the_demonstration_exactly(recorded: RecordedEpisode) -> None:
    """Same physics, same inputs, same motion: nothing drifts, although nobody looks where the arm goes."""
    result = replay(recorded, "wrenches")
    assert result.verdict == recorded.verdict
    assert result.worst == 0.0  # [m]


@pytest.mark.simulator
def test_other_wrenches_move_the_arm_elsewhere(recorded: RecordedEpisode) -> None:
    weaker = replace(recorded.pulls, forces=0.99 * recorded.pulls.forces)
    assert replay(replace(recorded, pulls=weaker), "wrenches").worst > 0.001  # [m]


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
        if name not in ("scene", "robot", "seed", "verdict", "picture", "detections", "camera", "pulls")
    }
    replay(replace(recorded, **short), "joints", observer=lambda: steps.append(None))
    assert len(steps) >= 20 * 5


def test_an_episode_without_joint_states_cannot_be_replayed() -> None:
    nothing = np.zeros((50, 0))
    imported = replace(episode(), joint_positions=nothing, joint_velocities=nothing, joint_torques=nothing)
    with pytest.raises(DataError, match="has no joint states; it cannot be replayed"):
        replay(imported, "joints")


def test_an_episode_without_the_pull_of_every_step_is_not_replayed_by_wrenches() -> None:
    with pytest.raises(DataError, match="replay it by its joints"):
        replay(replace(episode(), pulls=Pulls.none()), "wrenches")
