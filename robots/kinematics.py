"""Forward and inverse kinematics of an arm, in a simulation of its own that has no dynamics."""

from collections.abc import Sequence
from types import TracebackType

import numpy as np
from scipy.spatial.transform import Rotation

from cobot_lfd.arrays import Array
from cobot_lfd.errors import CobotError
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from cobot_lfd.quiet import quiet_output
from robots.body import RobotBody, connect
from robots.collision import CollisionCheck
from robots.description import RobotDescription

_TOLERANCE = 1e-6  # of position [m] and rotation [rad]; PyBullet's link states carry noise of about 3e-8
_SETTLED = (
    1e-4  # [rad]; a step this small means that the posture has settled, so that the joint path is smooth
)
_MAX_STEPS = 100
_POSTURE_GAIN = 0.8  # share of the way to the home posture per step, where the task leaves it free
_MAX_JOINT_STEP = 0.3  # [rad]; far goals are approached in steps for which the Jacobian still speaks
_DAMPING = 1e-6  # squared singular value below which a direction of the tool counts as lost


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
    PyBullet's own solver lets the elbow drift along a path and says nothing when it fails.
    """

    def __init__(self, description: RobotDescription) -> None:
        self._client = connect()
        self._body = RobotBody(self._client, description, self_collision=True)
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
        self._body.place(positions)
        return self._body.tool_pose()

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
        positions = np.array(start, dtype=np.float64)
        for _ in range(_MAX_STEPS):
            error = _pose_error(world_from_tool, self.forward(positions))
            step = self._step(positions, error)
            if np.abs(error).max() < _TOLERANCE and np.abs(step).max() < _SETTLED:
                self._require_limits(positions, world_from_tool)
                return positions
            positions = positions + step * min(1.0, _MAX_JOINT_STEP / max(np.abs(step).max(), 1e-12))
        raise NotConvergedError(
            f"the tool cannot reach {_told(world_from_tool)}: inverse kinematics comes no nearer than "
            f"{1e3 * np.linalg.norm(error[:3]):.1f} mm, {np.rad2deg(np.linalg.norm(error[3:])):.1f} degrees."
        )

    def follow(self, poses: Sequence[Pose], start: Array) -> Array:
        """Joint positions for a sequence of tool poses, each found from the one before.

        Args:
            poses: Poses of the tool in the world; neighbours are near each other.
            start: Joint positions to start from [rad], shape (n,).

        Returns:
            Joint positions [rad], shape (len(poses), n).

        Raises:
            KinematicsError: As for ``inverse``.
        """
        path = []
        for pose in poses:
            start = self.inverse(pose, start)
            path.append(start)
        return np.array(path)

    def collisions(self, obstacles: Sequence[Obstacle]) -> CollisionCheck:
        """A check of postures of this arm among obstacles."""
        return CollisionCheck(self._client, self._body, obstacles, (self._home, self._parked))

    def _step(self, positions: Array, error: Array) -> Array:
        """A damped step on the pose error, and towards home where that is free.

        The damping grows with the squared error, which keeps the steps sane at the edge of the arm's reach
        (Sugihara, Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method, 2011).
        """
        U, sigma, Vt = np.linalg.svd(self._body.jacobian(positions), full_matrices=False)
        task = Vt.T @ (sigma / (sigma**2 + _DAMPING + error @ error) * (U.T @ error))
        posture = _POSTURE_GAIN * (self._home - positions)
        return np.asarray(task + posture - Vt.T @ (Vt @ posture))

    def _require_limits(self, positions: Array, pose: Pose) -> None:
        outside = np.flatnonzero(
            (positions < self._limits.position_lower) | (positions > self._limits.position_upper)
        )
        if outside.size:
            i = int(outside[0])
            raise JointLimitError(
                f"the tool cannot reach {_told(pose)}: joint {i + 1} would be at {positions[i]:.3f} rad, but "
                f"can take {self._limits.position_lower[i]:.3f} to {self._limits.position_upper[i]:.3f} rad."
            )


def _pose_error(wanted: Pose, actual: Pose) -> Array:
    """Translation [m] and rotation vector [rad] from the actual to the wanted pose, shape (6,)."""
    rotation = Rotation.from_matrix(wanted.rotation @ actual.rotation.T).as_rotvec()
    return np.concatenate([wanted.position - actual.position, rotation])


def _told(pose: Pose) -> str:
    x, y, z = pose.position
    return f"({x:.3f}, {y:.3f}, {z:.3f}) m"
