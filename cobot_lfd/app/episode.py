"""One episode: see the scene, generate a path, plan the motion, carry it out, let the physics judge."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Any

import numpy as np

from cobot_lfd.app.compliance import Compliance, StiffnessField
from cobot_lfd.app.detour import detours, past_walls
from cobot_lfd.app.execute import Observer, execute
from cobot_lfd.app.geometry import farthest_from
from cobot_lfd.app.perceive import View, perceive
from cobot_lfd.app.plan import Stage, Surroundings, plan_motion
from cobot_lfd.app.results import EpisodeResult, SeenObject
from cobot_lfd.app.turns import turn_choices
from cobot_lfd.arrays import Array
from cobot_lfd.detection import NotSeen
from cobot_lfd.errors import ModelError, MotionError
from cobot_lfd.frame import Frame
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.method import PathModel
from cobot_lfd.motion import TimingMethod
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.outcome import Outcome, Verdict
from cobot_lfd.tool import ToolTurn
from robots import Arm, CollisionError, JointLimitError, Kinematics, NotConvergedError, RobotDescription
from scenes import SceneDescription, World, check_success, could_be_seen, object_obstacle, obstacles

_LEAST_DETOUR = 0.002  # [m] between path and way; what is less is no detour
_TIME_LIMIT = 60.0  # [s] of the arm's motion, after which a person would have stopped it

_FAILURES: dict[type[Exception], Outcome] = {
    ModelError: Outcome.GENERATION_FAILED,
    NotConvergedError: Outcome.IK_NOT_CONVERGED,
    JointLimitError: Outcome.UNREACHABLE_POSE,
    CollisionError: Outcome.COLLISION,
    MotionError: Outcome.LIMITS_VIOLATED,
}
"""Errors that end an episode, not the program."""


@dataclass(frozen=True, slots=True, eq=False)
class Bench:
    """What stays the same from episode to episode.

    Attributes:
        scene_name: Name of the scene.
        robot_name: Name of the robot.
        scene: The scene.
        robot: The robot.
        kinematics: Of the robot.
        model: What was learnt.
        covered: Whether something covers the camera's lens.
        misjudge: What becomes of a view before anything is done with it, given the seed; None: nothing.
        compliance: How the arm gives way during the carry; None: not at all.
        timing: How the motion along the path gets its times.
        client: The simulation in which episodes run one after the other; None: one of its own for each.
    """

    scene_name: str
    robot_name: str
    scene: SceneDescription
    robot: RobotDescription
    kinematics: Kinematics
    model: PathModel
    covered: bool = False
    misjudge: Callable[[View, int], View] | None = None
    compliance: Compliance | None = None
    timing: TimingMethod = "simple"
    client: Any = None


@dataclass(frozen=True, slots=True, eq=False)
class EpisodeRun:
    """An episode with all that a person may want to look at.

    Attributes:
        result: What happened.
        view: What the camera saw.
        path: The path that was generated; None where it did not come to that.
        detour: The way round something that was planned instead [m], shape (T, 2); None for no such way.
        true_frames: Where the objects stood; only for those who judge the episode.
    """

    result: EpisodeResult
    view: View
    path: GeneratedPath | None
    detour: Array | None
    true_frames: Mapping[str, Frame]


class _EpisodeFailedError(Exception):
    """Ends an episode early; never leaves this file."""

    def __init__(self, verdict: Verdict) -> None:
        super().__init__(verdict.sentence)
        self.verdict = verdict


@dataclass(slots=True)
class _Notes:
    """What is known of the episode so far."""

    times: dict[str, float] = field(default_factory=dict)
    metrics: dict[str, float] = field(default_factory=dict)
    path: GeneratedPath | None = None
    detour: Array | None = None
    duration: float | None = None

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Note how long the program needs for a stage, also where it fails."""
        start = perf_counter()
        try:
            yield
        finally:
            self.times[stage] = perf_counter() - start


def run_episode(bench: Bench, seed: int, *, film: Callable[[World], Observer] | None = None) -> EpisodeRun:
    """Perform the task once in the scene that the seed lays out.

    From the picture on, nothing but the success check knows where the objects really are.

    Args:
        bench: Scene, robot and model.
        seed: Decides the scene's layout.
        film: Given the world, returns what is to be called after each step of the simulation.
    """
    notes = _Notes()
    with ExitStack() as ending:
        with notes.timed("build"):
            world = ending.enter_context(World(bench.scene, seed, client=bench.client))
            arm = Arm(world.client, bench.robot, visible=film is not None or _in_picture(bench))
        true_frames = world.true_frames()
        with notes.timed("perceive"):
            view = perceive(world, covered=bench.covered, recognition=bench.model.recognition)
        if bench.misjudge is not None:
            view = bench.misjudge(view, seed)
        try:
            verdict = _attempt(bench, world, arm, view, notes, film(world) if film else None)
        except _EpisodeFailedError as failure:
            verdict = failure.verdict
        except tuple(_FAILURES) as error:
            verdict = Verdict(_FAILURES[type(error)], str(error))
    result = _result(bench, seed, verdict, view, true_frames, notes)
    return EpisodeRun(result, view, notes.path, notes.detour, true_frames)


def _attempt(
    bench: Bench, world: World, arm: Arm, view: View, notes: _Notes, observer: Observer | None
) -> Verdict:
    """Generate, plan, execute, check."""
    frames = _required_frames(bench, view)
    with notes.timed("generate"):
        notes.path = bench.model.reproduce(frames)
    path = notes.path.mean
    _require_on_table(bench.scene, path)
    with notes.timed("plan"):
        turns, around = _turns(bench, view), _surroundings(bench, view)
        stages = plan_motion(
            bench.kinematics,
            bench.robot,
            bench.scene.task,
            path,
            turns,
            around,
            detours=_detours(bench, view, notes.path),
            timing=bench.timing,
        )
        carry = next(stage.trajectory for stage in stages if stage.name == "carry")
        planned = carry.positions(np.linspace(0.0, carry.duration, len(path)))
        way = bench.kinematics.tool_positions(planned)[:, :2]
    notes.metrics["detour"] = farthest_from(path, way)
    notes.detour = way if notes.metrics["detour"] > _LEAST_DETOUR else None
    notes.duration = sum(stage.trajectory.duration for stage in stages)
    notes.metrics["path_length"] = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    if notes.duration > _TIME_LIMIT:
        detail = f"the motion would take {notes.duration:.0f} s; {_TIME_LIMIT:.0f} s are allowed"
        raise _EpisodeFailedError(Verdict(Outcome.TIMEOUT, detail))
    with notes.timed("execute"):
        return _carry_out(world, arm, stages, way, notes, observer, bench.compliance)


def _carry_out(
    world: World,
    arm: Arm,
    stages: tuple[Stage, ...],
    way: Array,
    notes: _Notes,
    observer: Observer | None,
    compliance: Compliance | None,
) -> Verdict:
    generated = notes.path
    soft = StiffnessField(compliance, generated) if compliance and generated else None
    execution = execute(world, arm, stages, observer=observer, stiffness=soft)
    if len(execution.carried):
        notes.metrics["tracking_error"] = farthest_from(way, execution.carried)
    return execution.failure or check_success(world, (arm.body.id,))


def _in_picture(bench: Bench) -> bool:
    """Whether the parked arm, or its shadow, could be in the picture that is taken before it moves."""
    boxes = bench.kinematics.boxes(np.array(bench.robot.parked))
    return could_be_seen(boxes, bench.scene.camera, bench.scene.light)


def _required_frames(bench: Bench, view: View) -> dict[str, Frame]:
    """The frames that the model needs; fails where one of them, or what the task needs, was not seen."""
    task = bench.scene.task
    rules = [rule.frame for rule in (task.start_yaw, task.end_yaw) if rule is not None]
    needed = view.find_for(bench.model)
    frames = {}
    for name, found in [*needed.items(), *((name, view.find(name)) for name in (task.pick, *rules))]:
        if isinstance(found, NotSeen):
            raise _EpisodeFailedError(Verdict(Outcome.OBJECT_NOT_SEEN, f"{name}: {found.reason}"))
        frames[name] = found.frame
    return {name: frames[name] for name in needed}


def _turns(bench: Bench, view: View) -> tuple[ToolTurn, ...]:
    """How the tool may be turned, as far as what was seen decides it."""
    home = bench.kinematics.forward(np.array(bench.robot.home)).rotation
    preferred = float(np.arctan2(home[1, 0], home[0, 0]))
    return turn_choices(bench.scene.task, view.frames, preferred)


def _surroundings(bench: Bench, view: View) -> Surroundings:
    """What the arm must not hit, where it was seen."""
    scene, pick = bench.scene, bench.scene.task.pick
    frames = view.frames | {item.name: item.frame for item in view.others}
    around = obstacles(scene, {name: frame for name, frame in frames.items() if name != pick})
    part = object_obstacle(scene, pick, frames[pick]) if scene.task.grips else None
    return Surroundings(around, part)


def _detours(bench: Bench, view: View, path: GeneratedPath) -> Iterator[Array]:
    """Ways to go instead of a path where that is not free, the best first."""
    aside = _aside(bench, view)
    yield from detours(path, aside)
    walls = _walls_of_goal(bench, view)
    if walls is not None:
        yield from past_walls(path, walls, aside)


def _walls_of_goal(bench: Bench, view: View) -> Obstacle | None:
    """The boxes of what the path ends in that are in the carried part's way; None where there are none."""
    task = bench.scene.task
    if task.place not in view.frames:
        return None
    goal = object_obstacle(bench.scene, task.place, view.frames[task.place])
    lifted = task.carry_height - task.grasp_height  # The part stood on the table.
    high = goal.centres[:, 2] + goal.half_sizes[:, 2] > lifted
    if not high.any():
        return None
    return replace(goal, centres=goal.centres[high], half_sizes=goal.half_sizes[high])


def _aside(bench: Bench, view: View) -> list[Obstacle]:
    """What has nothing to do with the task, so that a path may be bent around it."""
    return [object_obstacle(bench.scene, item.name, item.frame) for item in view.others]


def _require_on_table(scene: SceneDescription, path: Array) -> None:
    low = np.array(scene.table.centre) - 0.5 * np.array(scene.table.size)
    high = np.array(scene.table.centre) + 0.5 * np.array(scene.table.size)
    outside = np.flatnonzero(((path < low) | (path > high)).any(axis=1))
    if outside.size:
        x, y = path[outside[0]]
        detail = f"at ({x:.3f}, {y:.3f}) m it is not above the table"
        raise _EpisodeFailedError(Verdict(Outcome.PATH_LEAVES_WORKSPACE, detail))


def _result(
    bench: Bench, seed: int, verdict: Verdict, view: View, true_frames: Mapping[str, Frame], notes: _Notes
) -> EpisodeResult:
    return EpisodeResult(
        seed=seed,
        scene=bench.scene_name,
        robot=bench.robot_name,
        method=bench.model.method,
        verdict=verdict,
        objects=tuple(SeenObject.of(seen, true_frames[seen.name]) for seen in view.detections),
        duration=notes.duration,
        metrics=notes.metrics,
        times=notes.times,
    )
