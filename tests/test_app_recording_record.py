"""Recording: a hand pulls, the physics moves the arm, and what was recorded is what happened."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from cobot_lfd.app.cli import main
from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.store import list_episodes, load_episode
from cobot_lfd.app.recording.hand import HandAction, ScriptedHand
from cobot_lfd.app.recording.record import record_episode, record_session
from cobot_lfd.app.recording.script import Script, minimum_jerk, write_script
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame
from cobot_lfd.pose import Pose
from cobot_lfd.tool import ToolTurn
from robots import ArmState, Kinematics, load_robot
from scenes import load_scene

SCENE = load_scene("pick_and_place")
FRAMES = {"cube": Frame(np.array([0.5, -0.2]), 0.1), "container": Frame(np.array([0.45, 0.2]), 0.5)}
START = Pose(np.array([0.2, 0.0, 0.5]), np.diag([1.0, -1.0, -1.0]))
TICK = 0.01  # [s]


def script(seed: int) -> Script:
    rng = np.random.default_rng(seed)
    return write_script(
        SCENE.task,
        FRAMES,
        start=START,
        turn=ToolTurn.none(0.1),
        maximum_opening=0.08,
        time_step=TICK,
        rng=rng,
    )


def pull(tool: Pose) -> HandAction:
    """What the hand does in its first tick to an arm at rest."""
    zeros = np.zeros(7)
    action = ScriptedHand(script(0), TICK).act(
        ArmState(zeros, zeros, zeros, tool, np.zeros(3), np.zeros(3), 0.08)
    )
    assert action is not None
    return action


@pytest.fixture(scope="module")
def episode(demonstrations_folder: Path) -> RecordedEpisode:
    return load_episode(list_episodes(demonstrations_folder)[0])


def test_where_nothing_can_be_kept_nothing_is_recorded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "demos").write_text("not a folder")
    assert main(["record", "pick_and_place", "--out", str(tmp_path / "demos" / "mine")]) == 2
    [line] = capsys.readouterr().err.splitlines()
    assert "cannot save episodes in" in line


def test_a_minimum_jerk_movement_is_symmetric_and_starts_and_ends_at_rest() -> None:
    u = np.linspace(0.0, 1.0, 1001)
    share = minimum_jerk(u)
    assert_allclose(share + minimum_jerk(1 - u), 1.0)
    assert_allclose(share[[0, -1]], [0.0, 1.0])
    assert_allclose(np.gradient(share, u)[[0, -1]], 0.0, atol=1e-4)


def test_a_script_leads_the_part_to_its_goal_without_a_jump() -> None:
    written = script(0)
    carried = written.positions[written.carrying]
    assert_allclose(carried[0, :2], FRAMES["cube"].position, atol=0.01)
    assert_allclose(carried[-1, :2], FRAMES["container"].position, atol=0.025)
    assert_allclose(carried[:, 2], SCENE.task.carry_height)
    assert_array_equal(written.openings[written.carrying], 0.0)
    assert np.abs(np.diff(written.positions, axis=0)).max() < 0.02  # [m] in a tick


def test_the_same_seed_writes_the_same_script_and_another_seed_another_one() -> None:
    assert_array_equal(script(1).positions, script(1).positions)
    assert script(1).positions.shape != script(2).positions.shape


def test_a_hand_pulls_towards_where_it_wants_to_be_with_limited_force() -> None:
    ahead = START.position - [0.01, 0.0, 0.0]
    action = pull(Pose(ahead, START.rotation))
    assert action.force[0] > 1.0
    assert_allclose(action.force[1:], 0.0, atol=0.1)
    assert_allclose(action.torque, 0.0, atol=1e-9)
    far = pull(Pose(START.position - [1.0, 0.0, 0.0], START.rotation))
    assert np.linalg.norm(far.force) == pytest.approx(60.0)


def test_a_hand_at_its_place_does_not_pull() -> None:
    assert_allclose(pull(START).force, 0.0, atol=0.1)  # [N]


@pytest.mark.simulator
def test_the_arm_lags_behind_the_hand_and_not_the_other_way_round(episode: RecordedEpisode) -> None:
    """The force points along the motion while the part is carried: the hand moves the arm."""
    velocities = np.gradient(episode.tool_positions, episode.times, axis=0)
    power = (episode.hand_forces * velocities).sum(axis=1)[episode.carrying]
    assert power.sum() > 0
    assert np.abs(episode.hand_forces).max() <= 60.0


@pytest.mark.simulator
def test_the_recorded_tool_is_where_the_recorded_joints_put_it(episode: RecordedEpisode) -> None:
    with Kinematics(load_robot("panda")) as kinematics:
        for i in range(0, len(episode.times), 100):
            assert_allclose(
                kinematics.forward(episode.joint_positions[i]).position, episode.tool_positions[i], atol=1e-5
            )


@pytest.mark.simulator
def test_the_demonstration_leads_from_the_cube_to_the_container(demonstrations_folder: Path) -> None:
    for file in list_episodes(demonstrations_folder):
        episode = load_episode(file)
        assert episode.verdict.succeeded, episode.verdict.sentence
        demonstration = episode.demonstration()
        assert np.linalg.norm(demonstration.path[0] - demonstration.frames["cube"].position) < 0.01
        assert np.linalg.norm(demonstration.path[-1] - demonstration.frames["container"].position) < 0.03
        assert np.ptp(episode.tool_positions[episode.carrying, 2]) < 0.01


@pytest.mark.simulator
def test_the_same_seed_records_the_same_bits(episode: RecordedEpisode) -> None:
    again = record_episode("pick_and_place", "panda", episode.seed)
    for name in ("times", "joint_positions", "hand_forces", "tool_positions", "picture"):
        assert_array_equal(getattr(again, name), getattr(episode, name))


@pytest.mark.simulator
def test_recording_adds_to_a_folder_and_takes_new_seeds(tmp_path: Path) -> None:
    for expected in (5, 6):
        [episode] = record_session("pick_and_place", "panda", tmp_path, n_episodes=1, first_seed=5)
        assert episode.seed == expected
    assert [load_episode(file).seed for file in list_episodes(tmp_path)] == [5, 6]


@pytest.mark.simulator
def test_another_scene_is_not_recorded_into_the_same_folder(demonstrations_folder: Path) -> None:
    with pytest.raises(DataError, match=r"holds demonstrations of pick_and_place with panda"):
        record_session("pick_and_place", "iiwa", demonstrations_folder, n_episodes=1, first_seed=0)
