"""Forward and inverse kinematics of an arm, in a simulation of its own that has no dynamics."""

from collections.abc import Sequence
from dataclasses import dataclass
from types import TracebackType

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from cobot_lfd.arrays import Array
from cobot_lfd.errors import CobotError
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from cobot_lfd.quiet import quiet_output
from robots.body import RobotBody, connect
from robots.chain import Chain, Reach
from robots.collision import CollisionCheck
from robots.description import RobotDescription

_TOLERANCE = 1e-6  # of position [m] and rotation [rad]
_SETTLED = 1e-6  # [rad]; what smaller steps would still change bends a joint path by nothing that takes time
_MAX_STEPS = 100
_POSTURE_GAIN = 0.8  # share of the way to the home posture per step, where the task leaves it free
_MAX_JOINT_STEP = 0.3  # [rad]; far goals are approached in steps for which the Jacobian still speaks
_DAMPING = 1e-6  # squared singular value below which a direction of the tool counts as lost
_ROUNDING = 1e-10  # the same, where all that is wanted is a number to divide by
_MOST_CHECKS = 50  # until their simulation is emptied: shapes of removed bodies stay there, 20 kB a check
_LEAP = 0.3  # [rad]; neighbours of a path that are farther apart lie on different branches


class KinematicsError(CobotError):
    """No joint positions bring the tool to a pose."""


class NotConvergedError(KinematicsError):
    """The inverse kinematics found nothing near enough to the pose."""


class JointLimitError(KinematicsError):
    """The joint positions that reach the pose are outside the joint limits."""


class CollisionError(KinematicsError):
    """The arm would hit something."""


class Kinematics:
    """Forward and inverse kinematics of an arm.

    The steps of the inverse kinematics are Levenberg-Marquardt steps on the pose error, with a motion to the
    home posture in the null space of the Jacobian, so that a redundant arm's elbow stays where it belongs.
    All poses of a path take their steps at once. PyBullet's own solver lets the elbow drift along a path and
    says nothing when it fails.
    """

    def __init__(self, description: RobotDescription) -> None:
        self._client = connect()
        self._description = description
        self._body, self._n_checks = self._loaded(), 0
        self._chain = Chain.of(self._body)
        self._parked = np.array(description.parked)
        self._home = np.array(description.home)
        self._limits = description.joint_limits

    def __enter__(self) -> "Kinematics":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Leave the simulation."""
        with quiet_output():
            self._client.disconnect()

    def forward(self, positions: Array) -> Pose:
        """Pose of the tool in the world at joint positions [rad], shape (n,)."""
        reach = self._chain.reach(np.asarray(positions)[None])
        return Pose(reach.positions[0], reach.rotations[0])

    def tool_positions(self, postures: Array) -> Array:
        """Where the tool is in the world [m], shape (M, 3), at joint positions [rad], shape (M, n)."""
        return self._chain.reach(postures).positions

    def boxes(self, positions: Array) -> Array:
        """Corners of boxes around the links [m], shape (K, 2, 3), at joint positions [rad], shape (n,)."""
        self._body.place(positions)
        return self._body.boxes()

    def inverse(self, world_from_tool: Pose, start: Array) -> Array:
        """Joint positions that bring the tool to a pose.

        Args:
            world_from_tool: The wanted pose of the tool.
            start: Joint positions to start from [rad], shape (n,); the solution is the near one.

        Returns:
            Joint positions [rad], shape (n,), whose tool pose differs by less than 1e-6 m and 1e-6 rad.

        Raises:
            NotConvergedError: If none is found.
            JointLimitError: If the one found is outside the joint limits.
        """
        found = self._solve((world_from_tool,), start)
        if not found.settled[0]:
            error = found.errors[0]
            raise NotConvergedError(
                f"the tool cannot reach {_told(world_from_tool)}: inverse kinematics comes no nearer than "
                f"{1e3 * np.linalg.norm(error[:3]):.1f} mm, {np.rad2deg(np.linalg.norm(error[3:])):.1f} "
                "degrees."
            )
        positions: Array = found.postures[0]
        self._require_limits(positions, world_from_tool)
        return positions

    def follow(self, poses: Sequence[Pose], start: Array) -> Array:
        """Joint positions for a sequence of tool poses.

        All are searched for at once, from the start. Where that fails, or does not give one path, each is
        found from the one before.

        Args:
            poses: Poses of the tool in the world; neighbours are near each other.
            start: Joint positions to start from [rad], shape (n,).

        Returns:
            Joint positions [rad], shape (len(poses), n).

        Raises:
            KinematicsError: As for ``inverse``.
        """
        found = self._solve(poses, start)
        if found.settled.all() and self._outside(found.postures) is None and _is_one_path(found.postures):
            return found.postures
        path = []
        for pose in poses:
            start = self.inverse(pose, start)
            path.append(start)
        return np.array(path)

    def collisions(self, obstacles: Sequence[Obstacle]) -> CollisionCheck:
        """A check of postures of this arm among obstacles; an earlier one must have ended."""
        if self._n_checks == _MOST_CHECKS:
            self._client.resetSimulation()
            self._body, self._n_checks = self._loaded(), 0
        self._n_checks += 1
        return CollisionCheck(self._client, self._body, self._chain, obstacles, (self._home, self._parked))

    def _loaded(self) -> RobotBody:
        return RobotBody(self._client, self._description, self_collision=True, visible=False)

    def _solve(self, poses: Sequence[Pose], start: Array) -> "_Found":
        """Search for each pose by itself, all at once; those that have settled wait for the others."""
        positions = np.array([pose.position for pose in poses])
        rotations = np.array([pose.rotation for pose in poses])
        postures = np.tile(np.asarray(start, dtype=np.float64), (len(poses), 1))
        errors = np.zeros((len(poses), 6))
        going = np.arange(len(poses))
        for _ in range(_MAX_STEPS):
            reach = self._chain.reach(postures[going])
            errors[going] = error = _pose_errors(positions[going], rotations[going], reach)
            step = self._steps(postures[going], error, reach.jacobians)
            largest = np.abs(step).max(axis=1)
            far = (np.abs(error).max(axis=1) >= _TOLERANCE) | (largest >= _SETTLED)
            scale = np.minimum(1.0, _MAX_JOINT_STEP / np.maximum(largest, 1e-12))
            postures[going[far]] += (step * scale[:, None])[far]
            going = going[far]
            if not going.size:
                break
        settled = np.ones(len(poses), dtype=np.bool_)
        settled[going] = False
        return _Found(postures, errors, settled)

    def _steps(self, postures: Array, errors: Array, jacobians: Array) -> Array:
        """Damped steps on the pose errors, and towards home where that is free, shape (M, n).

        The damping grows with the squared error, which keeps the steps sane at the edge of the arm's reach
        (Sugihara, Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method, 2011).
        """
        transposed = np.swapaxes(jacobians, 1, 2)
        gram = jacobians @ transposed
        damping = _DAMPING + (errors**2).sum(axis=1)
        task = np.linalg.solve(gram + damping[:, None, None] * np.eye(6), errors[..., None])
        posture = _POSTURE_GAIN * (self._home - postures)[..., None]
        moved = np.linalg.solve(gram + _ROUNDING * np.eye(6), jacobians @ posture)
        return np.asarray((posture + transposed @ (task - moved))[..., 0])

    def _outside(self, postures: Array) -> tuple[int, int] | None:
        """The first posture that is outside the joint limits, and its first joint that is."""
        outside = (postures < self._limits.position_lower) | (postures > self._limits.position_upper)
        if not outside.any():
            return None
        row, joint = np.argwhere(outside)[0]
        return int(row), int(joint)

    def _require_limits(self, positions: Array, pose: Pose) -> None:
        outside = self._outside(positions[None])
        if outside is not None:
            i = outside[1]
            raise JointLimitError(
                f"the tool cannot reach {_told(pose)}: joint {i + 1} would be at {positions[i]:.3f} rad, but "
                f"can take {self._limits.position_lower[i]:.3f} to {self._limits.position_upper[i]:.3f} rad."
            )


@dataclass(frozen=True, slots=True, eq=False)
class _Found:
    """Where a search has ended.

    Attributes:
        postures: Joint positions [rad], shape (M, n).
        errors: What their poses lack, translation [m] and rotation vector [rad], shape (M, 6).
        settled: Whether each is a solution, shape (M,).
    """

    postures: Array
    errors: Array
    settled: NDArray[np.bool_]


def _is_one_path(postures: Array) -> bool:
    """Whether neighbours lie near each other."""
    return bool((np.abs(np.diff(postures, axis=0)) < _LEAP).all())


def _pose_errors(positions: Array, rotations: Array, reach: Reach) -> Array:
    """Translation [m] and rotation vector [rad] from the actual to the wanted poses, shape (M, 6)."""
    turns = Rotation.from_matrix(rotations @ np.swapaxes(reach.rotations, 1, 2), assume_valid=True)
    return np.hstack([positions - reach.positions, turns.as_rotvec()])


def _told(pose: Pose) -> str:
    x, y, z = pose.position
    return f"({x:.3f}, {y:.3f}, {z:.3f}) m"
