"""How close to the fastest motion the timing comes: both methods against TOPP-RA on the same paths.

TOPP-RA (Pham and Pham, IEEE Transactions on Robotics 34, 2018) knows velocity and acceleration limits only:
no motion that keeps jerk limits as well can be faster, but for the error of the grid that TOPP-RA works on.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

import numpy as np
import toppra
import tyro
from scipy.interpolate import make_interp_spline
from toppra import algorithm, constraint
from toppra.interpolator import AbstractGeometricPath

from cobot_lfd.app.plan import plan_motion
from cobot_lfd.app.turns import turn_choices
from cobot_lfd.arrays import Array
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.motion import JointLimits, JointPath, limit_ratios, time_path
from cobot_lfd.motion.timing import METHODS, TimingMethod
from cobot_lfd.tool import tool_above
from robots import Kinematics, RobotDescription, load_robot
from scenes import World, load_scene

N_WAYPOINTS = 200
N_GRID = 2000
HEIGHT = 0.15  # [m] of the planar paths above the table


@dataclass(frozen=True, slots=True)
class Measurement:
    """One path timed by one method under one set of limits.

    Attributes:
        ratio: Duration over TOPP-RA's.
        usage: Largest ratio of velocity, acceleration or jerk to its limit, by finite differences at 4 kHz.
        seconds: Time of computation [s].
    """

    ratio: float
    usage: float
    seconds: float


class ToppraPath(AbstractGeometricPath):  # type: ignore[misc]  # toppra has no type hints.
    """A joint path as TOPP-RA wants it."""

    def __init__(self, path: JointPath) -> None:
        self._path = path

    def __call__(self, s: Array, order: int = 0) -> Array:
        """Positions or derivatives at ``s``."""
        return self._path(s, order)

    @property
    def dof(self) -> int:
        """Number of joints."""
        return self._path.n_joints

    @property
    def path_interval(self) -> Array:
        """Where s begins and ends."""
        return np.array([0.0, 1.0])

    @property
    def waypoints(self) -> None:
        """There are none."""


def topp_ra_duration(path: JointPath, limits: JointLimits) -> float:
    """The least duration within velocity and acceleration limits, by TOPP-RA on a fine grid [s]."""
    grid = np.linspace(0.0, 1.0, N_GRID + 1)
    bounds = [
        constraint.JointVelocityConstraint(np.column_stack([-limits.velocity, limits.velocity])),
        constraint.JointAccelerationConstraint(np.column_stack([-limits.acceleration, limits.acceleration])),
    ]
    solver = algorithm.TOPPRA(bounds, ToppraPath(path), gridpoints=grid, solver_wrapper="seidel")
    _, pace, _ = solver.compute_parameterization(0.0, 0.0)
    return float(np.sum(2 * np.diff(grid) / (pace[1:] + pace[:-1])))


def random_paths(n: int, rng: np.random.Generator, n_joints: int) -> list[JointPath]:
    """Splines through six random positions."""
    shares = np.linspace(0.0, 1.0, N_WAYPOINTS)
    vias = rng.uniform(-1.0, 1.0, (n, 6, n_joints))
    return [JointPath.through(make_interp_spline(np.linspace(0, 1, 6), via, k=3)(shares)) for via in vias]


def planar_paths(n: int, rng: np.random.Generator, robot: RobotDescription) -> list[JointPath]:
    """The robot's joints while its tool draws a random curve over the table, from right to left."""
    shares = np.linspace(0.0, 1.0, N_WAYPOINTS)
    with Kinematics(robot) as kinematics:
        paths = []
        for _ in range(n):
            corners = np.column_stack([rng.uniform(0.4, 0.6, 5), np.linspace(-0.3, 0.3, 5)])
            curve = make_interp_spline(np.linspace(0, 1, 5), corners, k=3)(shares)
            poses = [tool_above(point, HEIGHT, 0.0) for point in curve]
            start = kinematics.inverse(poses[0], np.array(robot.home))
            paths.append(JointPath.through(kinematics.follow(poses, start)))
    return paths


def scene_paths(
    n: int, seed: int, robot: RobotDescription, scene_name: str, model_file: Path
) -> list[JointPath]:
    """The joint paths of a learnt task in new scenes, less those along which the joints go straight."""
    scene, model = load_scene(scene_name), TaskParameterisedGMM.load(model_file)
    paths = []
    with Kinematics(robot) as kinematics:
        for i in range(n):
            with World(scene, seed + i) as world:
                frames = world.true_frames()
            curve = model.reproduce({name: frames[name] for name in model.frame_kinds}).mean
            stages = plan_motion(kinematics, robot, scene.task, curve, turn_choices(scene.task, frames))
            paths += [section.path for stage in stages for section in stage.trajectory.sections]
    return [path for path in paths if path.degree > 1]


def without_position_limits(limits: JointLimits) -> JointLimits:
    """The same limits for paths anywhere: random paths know nothing of the arm."""
    far = np.full(limits.n_joints, 100.0)
    return replace(limits, position_lower=-far, position_upper=far)


def measure(path: JointPath, limits: JointLimits, method: TimingMethod, least: float) -> Measurement:
    """Time a path, and compare with the least duration [s]."""
    start = perf_counter()
    trajectory = time_path(path, limits, method=method)
    seconds = perf_counter() - start
    ratios = limit_ratios(trajectory, limits)
    usage = max(ratios.velocity, ratios.acceleration, ratios.jerk)
    return Measurement(trajectory.duration / least, usage, seconds)


def row(name: str, limits: str, method: str, results: Sequence[Measurement]) -> str:
    """A line of the table."""

    def over(summary: Callable[[Array], np.float64], attribute: str) -> float:
        return float(summary(np.array([getattr(result, attribute) for result in results])))

    return (
        f"| {name} ({len(results)}) | {limits} | {method} | {over(np.median, 'ratio'):.3f} "
        f"| {over(np.max, 'ratio'):.3f} | {over(np.max, 'usage'):.4f} "
        f"| {over(np.median, 'seconds'):.2f} | {over(np.max, 'seconds'):.2f} |"
    )


def main(
    *,
    paths: int = 20,
    seed: int = 0,
    robot: str = "panda",
    scene: str = "pick_and_place",
    model: Path | None = None,
) -> int:
    """Compare both timing methods with TOPP-RA: durations over its durations, and times of computation.

    Args:
        paths: How many random and planar paths, and how many scenes.
        seed: Of the paths' randomness, and of the first scene.
        robot: Whose limits and kinematics to use.
        scene: Where the model performs its task.
        model: A learnt model (made by 'cobot-lfd fit'), to measure the joint paths of its task as well.
    """
    toppra.setup_logging("ERROR")
    description = load_robot(robot, load_scene(scene).task.tool)
    rng = np.random.default_rng(seed)
    sheet = without_position_limits(description.joint_limits)
    tight = replace(sheet, acceleration=sheet.acceleration / 4, jerk=10 * sheet.acceleration / 4)
    families = {
        "random": random_paths(paths, rng, sheet.n_joints),
        "planar": planar_paths(paths, rng, description),
    }
    if model is not None:
        families[scene] = scene_paths(paths, seed, description, scene, model)
    print("| paths | limits | method | median ratio | largest | limits used | median [s] | largest [s] |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, family in families.items():
        for kind, limits in {"data sheet": sheet, "tight": tight}.items():
            least = [topp_ra_duration(path, limits) for path in family]
            for method in METHODS:
                pairs = zip(family, least, strict=True)
                print(row(name, kind, method, [measure(p, limits, method, t) for p, t in pairs]), flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(tyro.cli(main))
