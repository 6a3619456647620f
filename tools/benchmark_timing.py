"""How close to the fastest motion the timing comes: both methods against TOPP-RA on the same paths.

TOPP-RA (Pham and Pham, IEEE Transactions on Robotics 34, 2018) knows velocity and acceleration limits only:
no motion that keeps jerk limits as well can be faster, but for the error of the grid that TOPP-RA works on.
Where a path is short, jerk limits alone take much longer than that: no joint can go its way, from rest to
rest, in less time than Ruckig says. The larger of both bounds is printed beside TOPP-RA's.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time

import numpy as np
import toppra
import tyro
from scipy.interpolate import make_interp_spline
from toppra import algorithm, constraint
from toppra.interpolator import AbstractGeometricPath

from cobot_lfd.app.geometry import farthest_from
from cobot_lfd.app.plan import plan_motion
from cobot_lfd.app.turns import turn_choices
from cobot_lfd.arrays import Array
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.motion import JointLimits, JointPath, limit_ratios, time_path
from cobot_lfd.motion.timing import METHODS, TimingMethod
from cobot_lfd.motion.timing_ruckig import rest_to_rest
from cobot_lfd.tool import tool_above
from robots import Kinematics, RobotDescription, load_robot
from scenes import SceneDescription, World, load_scene

N_WAYPOINTS = 200
N_GRID = 2000
HEIGHT = 0.15  # [m] of the planar paths above the table
NO_WAY = 1e-9  # [rad]; a joint that goes no farther stands still


@dataclass(frozen=True, slots=True)
class Measurement:
    """One path timed by one method under one set of limits.

    Attributes:
        ratio: Duration over TOPP-RA's.
        bound_ratio: Duration over the least that TOPP-RA and each joint's own way allow.
        usage: Largest ratio of velocity, acceleration or jerk to its limit, by finite differences at 4 kHz.
        seconds: Processor time of computation [s].
    """

    ratio: float
    bound_ratio: float
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


def least_duration(path: JointPath, limits: JointLimits) -> float:
    """The larger of TOPP-RA's bound and that of each joint alone, from end to end and rest to rest [s]."""
    ways = np.abs(path(1.0) - path(0.0))
    joints = zip(ways, limits.velocity, limits.acceleration, limits.jerk, strict=True)
    alone = [rest_to_rest(v / way, a / way, j / way).duration for way, v, a, j in joints if way > NO_WAY]
    return max(topp_ra_duration(path, limits), *alone, 0.0)


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


@dataclass(frozen=True, slots=True, eq=False)
class TaskPaths:
    """The joint paths of a learnt task in new scenes.

    Attributes:
        paths: Those along which the joints do not go straight.
        off_path: How far the tool leaves the generated path at most [m].
    """

    paths: list[JointPath]
    off_path: float


def task_paths(
    n: int, seed: int, robot: RobotDescription, scene: SceneDescription, model_file: Path
) -> TaskPaths:
    """Plan a learnt task in new scenes."""
    model = TaskParameterisedGMM.load(model_file)
    paths, off = [], 0.0
    with Kinematics(robot) as kinematics:
        for i in range(n):
            with World(scene, seed + i) as world:
                frames = world.true_frames()
            curve = model.reproduce({name: frames[name] for name in model.frame_kinds}).mean
            for stage in plan_motion(kinematics, robot, scene.task, curve, turn_choices(scene.task, frames)):
                sections = [section.path for section in stage.trajectory.sections]
                paths += [path for path in sections if path.degree > 1]
                if stage.name == "carry":
                    tool = kinematics.tool_positions(sections[0](np.linspace(0.0, 1.0, N_GRID)))
                    off = max(off, farthest_from(curve, tool[:, :2]))
    return TaskPaths(paths, off)


def without_position_limits(limits: JointLimits) -> JointLimits:
    """The same limits for paths anywhere: random paths know nothing of the arm."""
    far = np.full(limits.n_joints, 100.0)
    return replace(limits, position_lower=-far, position_upper=far)


def measure(
    path: JointPath, limits: JointLimits, method: TimingMethod, topp_ra: float, least: float
) -> Measurement:
    """Time a path, and compare with TOPP-RA's duration and with the least one [s]."""
    start = process_time()
    trajectory = time_path(path, limits, method=method)
    seconds = process_time() - start
    ratios = limit_ratios(trajectory, limits)
    usage = max(ratios.velocity, ratios.acceleration, ratios.jerk)
    return Measurement(trajectory.duration / topp_ra, trajectory.duration / least, usage, seconds)


def row(name: str, limits: str, method: str, results: Sequence[Measurement]) -> str:
    """A line of the table."""

    def over(summary: Callable[[Array], np.float64], attribute: str) -> float:
        return float(summary(np.array([getattr(result, attribute) for result in results])))

    return (
        f"| {name} ({len(results)}) | {limits} | {method} | {over(np.median, 'ratio'):.3f} "
        f"| {over(np.max, 'ratio'):.3f} | {over(np.max, 'bound_ratio'):.3f} | {over(np.max, 'usage'):.4f} "
        f"| {over(np.median, 'seconds'):.2f} | {over(np.max, 'seconds'):.2f} |"
    )


def compare(name: str, paths: Sequence[JointPath], limits: JointLimits, kind: str) -> None:
    """Print what both methods make of a family of paths."""
    bounds = [(topp_ra_duration(path, limits), least_duration(path, limits)) for path in paths]
    for method in METHODS:
        pairs = zip(paths, bounds, strict=True)
        print(row(name, kind, method, [measure(p, limits, method, *bound) for p, bound in pairs]), flush=True)


def main(
    *,
    paths: int = 20,
    seed: int = 0,
    robot: str = "panda",
    models: Path | None = None,
) -> int:
    """Compare both timing methods with TOPP-RA: durations over its durations, and processor times.

    Args:
        paths: How many random and planar paths, and how many placements of each scene.
        seed: Of the paths' randomness, and of the first placement.
        robot: Whose limits and kinematics to use.
        models: A folder with learnt models (made by 'cobot-lfd fit'), each named after its scene, to measure
            the joint paths of their tasks as well.
    """
    toppra.setup_logging("ERROR")
    arm = load_robot(robot)
    rng = np.random.default_rng(seed)
    sheet = without_position_limits(arm.joint_limits)
    tight = replace(sheet, acceleration=sheet.acceleration / 4, jerk=10 * sheet.acceleration / 4)
    families = {
        "random": random_paths(paths, rng, sheet.n_joints),
        "planar": planar_paths(paths, rng, arm),
    }
    off_path = {}
    for file in sorted(models.glob("*.npz")) if models is not None else []:
        scene = load_scene(file.stem)
        task = task_paths(paths, seed, load_robot(robot, scene.task.tool), scene, file)
        families[file.stem], off_path[file.stem] = task.paths, task.off_path
    print("| paths | limits | method | over TOPP-RA: median | largest | over both bounds: largest ", end="")
    print("| limits used | median [s] | largest [s] |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, family in families.items():
        for kind, limits in {"data sheet": sheet, "tight": tight}.items():
            compare(name, family, limits, kind)
    for name, off in off_path.items():
        print(f"{name}: the tool leaves the generated path by at most {1e3 * off:.3f} mm")
    return 0


if __name__ == "__main__":
    raise SystemExit(tyro.cli(main))
