"""A pose in space: a rotation followed by a translation."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from cobot_lfd.arrays import Array, frozen_array

_ORTHONORMAL = 1e-5  # by which products of a rotation's rows may differ from 0 and 1


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A rigid motion, named ``parent_from_child`` so that a chain reads by its neighbours.

    Attributes:
        position: Origin of the child in the parent [m], shape (3,).
        rotation: Rotation matrix from the child's axes to the parent's, shape (3, 3).
    """

    position: Array
    rotation: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "position", frozen_array(self.position, "position", (3,)))
        object.__setattr__(self, "rotation", frozen_array(self.rotation, "rotation", (3, 3)))
        if not _is_rotation(self.rotation):
            raise ValueError(
                "rotation is no rotation matrix: its rows must be orthonormal, its determinant 1."
            )

    @classmethod
    def identity(cls) -> "Pose":
        """The motion that moves nothing."""
        return cls(np.zeros(3), np.eye(3))

    @classmethod
    def from_quaternion(cls, position: ArrayLike, xyzw: ArrayLike) -> "Pose":
        """From a position [m] and a quaternion in the order x, y, z, w."""
        return cls(np.asarray(position, dtype=np.float64), _matrix(np.asarray(xyzw, dtype=np.float64)))

    @classmethod
    def from_rpy(cls, position: ArrayLike, rpy: ArrayLike) -> "Pose":
        """From a position [m] and roll, pitch, yaw [rad] about the fixed x, y, z axes, as in a URDF."""
        return cls(
            np.asarray(position, dtype=np.float64), Rotation.from_euler("xyz", np.asarray(rpy)).as_matrix()
        )

    @property
    def quaternion(self) -> Array:
        """The rotation as a unit quaternion in the order x, y, z, w, shape (4,)."""
        return np.asarray(Rotation.from_matrix(self.rotation).as_quat(), dtype=np.float64)

    def __matmul__(self, other: "Pose") -> "Pose":
        """Chain two poses: ``a_from_c = a_from_b @ b_from_c``."""
        return Pose(self.apply(other.position), self.rotation @ other.rotation)

    def inverse(self) -> "Pose":
        """The motion that undoes this one."""
        return Pose(-self.rotation.T @ self.position, self.rotation.T)

    def apply(self, points: ArrayLike) -> Array:
        """Take points given in the child [m], shape (..., 3), to the parent."""
        return np.asarray(points, dtype=np.float64) @ self.rotation.T + self.position

    def angle_to(self, other: "Pose") -> float:
        """Angle of the rotation between the two [rad]."""
        return float(Rotation.from_matrix(self.rotation.T @ other.rotation).magnitude())


def _matrix(xyzw: Array) -> Array:
    """The rotation of a quaternion of any length but 0; poses are read so often that it is quick."""
    x, y, z, w = xyzw.tolist()
    squared_length = x * x + y * y + z * z + w * w
    if squared_length == 0.0:
        raise ValueError("xyzw is a quaternion of length 0, which is no rotation.")
    twice = 2.0 / squared_length
    return np.array(
        [
            [1.0 - twice * (y * y + z * z), twice * (x * y - w * z), twice * (x * z + w * y)],
            [twice * (x * y + w * z), 1.0 - twice * (x * x + z * z), twice * (y * z - w * x)],
            [twice * (x * z - w * y), twice * (y * z + w * x), 1.0 - twice * (x * x + y * y)],
        ]
    )


def _is_rotation(matrix: Array) -> bool:
    """Whether a matrix is orthonormal and right-handed; thousands are checked per episode, so it is quick."""
    x, y, z = matrix.tolist()
    lengths_and_angles = (
        *(_dot(x, x) - 1.0, _dot(y, y) - 1.0, _dot(z, z) - 1.0),
        *(_dot(x, y), _dot(y, z), _dot(z, x)),
    )
    if max(map(abs, lengths_and_angles)) > _ORTHONORMAL:
        return False
    cross = (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])
    return _dot(cross, z) > 0.0


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
