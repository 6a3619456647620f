"""One episode: its frames come from the picture, its motion stays on the path, the physics judges it."""

import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cobot_lfd.app.episode import Bench, EpisodeRun, run_episode
from cobot_lfd.app.evaluate import Job, bench_for
from cobot_lfd.app.plan import Stage, plan_motion
from cobot_lfd.frame import Frame
from cobot_lfd.method import PathModel
from cobot_lfd.motion import JointLimits, JointPath, check_limits
from cobot_lfd.motion.time_law import TimeLaw
from cobot_lfd.motion.timing_stretch import stretch_to_limits
from cobot_lfd.outcome import Outcome
from cobot_lfd.tool import ToolTurn
from robots import Kinematics, load_robot
from scenes import World, load_scene

pytestmark = pytest.mark.simulator

SEED = 1000
PANDA, SCENE = load_robot("panda"), load_scene("pick_and_place")
CURVE = np.column_stack([0.5 + 0.08 * np.sin(np.linspace(0, np.pi, 80)), np.linspace(-0.2, 0.25, 80)])


@pytest.fixture(scope="module")
def bench(model_file: Path) -> Bench:
    return bench_for(Job("pick_and_place", "panda", model_file))


@pytest.fixture(scope="module")
def episode(bench: Bench) -> EpisodeRun:
    return run_episode(bench, SEED)


@pytest.fixture(scope="module")
def stages() -> tuple[Stage, ...]:
    with Kinematics(PANDA) as kinematics:
        return plan_motion(kinematics, PANDA, SCENE.task, CURVE, [ToolTurn.none(0.2)])


def changed(bench: Bench, **changes: Any) -> Bench:
    fields = {name: getattr(bench, name) for name in Bench.__slots__}
    return Bench(**(fields | changes))


def test_an_episode_succeeds(episode: EpisodeRun) -> None:
    assert episode.result.verdict.outcome is Outcome.SUCCESS, episode.result.verdict.sentence
    assert episode.result.metrics["tracking_error"] < 0.002  # [m]


def test_the_frames_come_from_the_picture(bench: Bench) -> None:
    """With the camera covered there are none, although the simulator knows them all."""
    run = run_episode(changed(bench, covered=True), SEED)
    assert run.result.verdict.outcome is Outcome.OBJECT_NOT_SEEN
    assert run.view.frames == {}
    assert run.path is None


def test_the_pipeline_believes_the_picture_and_not_the_simulator(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A picture of another scene leads the arm to where the objects are not."""
    with World(SCENE, SEED + 1) as other:
        wrong_picture = other.take_picture()
    monkeypatch.setattr(World, "take_picture", lambda *_, **__: wrong_picture)
    verdict = run_episode(bench, SEED).result.verdict
    assert verdict.outcome in (Outcome.GRASP_FAILED, Outcome.GRASP_LOST)


def test_nothing_is_lifted_before_the_grasp_is_verified(bench: Bench) -> None:
    """Led to a place without a cube, the fingers close on nothing, and the arm stops where it stands."""
    heights: list[float] = []
    elsewhere = Frame(np.array([0.55, 0.0]), 0.0)
    astray = PathTo(bench.model, elsewhere, "cube")

    def watch(world: World) -> Callable[[], None]:
        arm = next(i for i in range(world.client.getNumBodies()) if world.client.getNumJoints(i) > 6)
        tool = world.client.getNumJoints(arm) - 1
        return lambda: heights.append(world.client.getLinkState(arm, tool, 0, True)[4][2])

    verdict = run_episode(changed(bench, model=astray), SEED, film=watch).result.verdict
    assert verdict.outcome is Outcome.GRASP_FAILED
    assert heights[-1] == pytest.approx(min(heights), abs=0.001)  # [m]


def test_a_motion_beyond_the_limits_is_not_executed(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every episode's motion passes the check by finite differences: one per cent too fast ends it."""

    def hurried(path: JointPath, law: TimeLaw, limits: JointLimits) -> TimeLaw:
        return stretch_to_limits(path, law, limits).stretched(0.99)

    monkeypatch.setattr("cobot_lfd.motion.timing.stretch_to_limits", hurried)
    run = run_episode(bench, SEED, film=lambda _: pytest.fail)
    assert run.result.verdict.outcome is Outcome.LIMITS_VIOLATED
    assert "its limit is" in run.result.verdict.detail


def test_near_optimal_timing_and_compliance_are_options(model_file: Path, episode: EpisodeRun) -> None:
    other = bench_for(Job("pick_and_place", "panda", model_file, compliant=True, timing="near_optimal"))
    run = run_episode(other, SEED)
    assert run.result.verdict.outcome is Outcome.SUCCESS, run.result.verdict.sentence
    hurried, usual = run.result.duration, episode.result.duration
    assert hurried is not None
    assert usual is not None
    assert hurried < 0.95 * usual
    stiff, soft = (r.result.metrics["tracking_error"] for r in (episode, run))
    assert stiff < soft < 0.002  # [m]


def test_what_the_camera_sees_is_where_it_says(episode: EpisodeRun) -> None:
    for seen in episode.result.objects:
        assert seen.position_error < 0.001  # [m]
        assert np.rad2deg(seen.angle_error) < 1.0


def test_the_tool_stays_within_a_millimetre_of_the_path(stages: tuple[Stage, ...]) -> None:
    carry = next(stage for stage in stages if stage.name == "carry").trajectory
    line = np.column_stack([np.interp(np.linspace(0, 1, 20000), np.linspace(0, 1, 80), c) for c in CURVE.T])
    with Kinematics(PANDA) as kinematics:
        for joints in carry.every(carry.duration / 100).positions:
            tool = kinematics.forward(joints).position
            assert np.linalg.norm(line - tool[:2], axis=1).min() < 0.001  # [m]
            assert tool[2] == pytest.approx(SCENE.task.carry_height, abs=0.001)


def test_every_stage_keeps_the_data_sheets_limits_and_starts_where_the_last_one_ended(
    stages: tuple[Stage, ...],
) -> None:
    at = np.array(PANDA.parked)
    for stage in stages:
        check_limits(stage.trajectory, PANDA.joint_limits)
        np.testing.assert_allclose(stage.trajectory.start, at, atol=1e-6)  # [rad]
        at = stage.trajectory.goal
    np.testing.assert_allclose(at, PANDA.parked, atol=1e-6)


def test_planning_needs_no_network(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise AssertionError("something opened a socket")

    monkeypatch.setattr(socket, "socket", refuse)
    with Kinematics(PANDA) as kinematics:
        assert plan_motion(kinematics, PANDA, SCENE.task, CURVE, [ToolTurn.none(0.2)])


class PathTo:
    """Stands for a model that leads somewhere else."""

    method = "test"
    recognition = None

    def __init__(self, model: PathModel, place: Frame, name: str = "container") -> None:
        self.frame_kinds = model.frame_kinds
        self._model = model
        self._astray = {name: place}

    def reproduce(self, frames: dict[str, Frame]) -> Any:
        """The path from or to another place."""
        return self._model.reproduce({**frames, **self._astray})


@pytest.mark.parametrize(
    ("goal", "outcome"),
    [
        ((0.45, 0.55), Outcome.NOT_PLACED),
        ((0.8, 0.75), Outcome.IK_NOT_CONVERGED),
        ((5.0, 0.0), Outcome.PATH_LEAVES_WORKSPACE),
    ],
)
def test_a_failure_is_told(bench: Bench, goal: tuple[float, float], outcome: Outcome) -> None:
    astray = PathTo(bench.model, Frame(np.array(goal), 0.0))
    verdict = run_episode(changed(bench, model=astray), SEED).result.verdict
    assert verdict.outcome is outcome
    assert verdict.detail
