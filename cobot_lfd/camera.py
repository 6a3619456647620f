"""A camera: where it stands, and how points in the world land in its picture."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.lens import distort, undistort
from cobot_lfd.pose import Pose


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """A camera, in OpenCV's convention: x right, y down, z into the picture.

    Pixel centres lie at whole numbers: the picture's top left pixel covers (-0.5, -0.5) to (0.5, 0.5).

    Attributes:
        width: Picture width [px].
        height: Picture height [px].
        matrix: Intrinsic matrix [px], shape (3, 3).
        world_from_camera: Pose of the camera in the world.
        distortion: What the lens does, see ``cobot_lfd.lens``: k1, k2, p1, p2, k3, shape (5,).
    """

    width: int
    height: int
    matrix: Array
    world_from_camera: Pose
    distortion: Array = field(default_factory=lambda: np.zeros(5))
    _camera_from_world: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "matrix", frozen_array(self.matrix, "matrix", (3, 3)))
        object.__setattr__(self, "distortion", frozen_array(self.distortion, "distortion", (5,)))
        if self.width < 1 or self.height < 1:
            raise ValueError(f"the picture is {self.width} x {self.height} px; both must be at least 1.")
        camera_from_world = self.world_from_camera.inverse()
        motion = np.column_stack([camera_from_world.rotation, camera_from_world.position])
        object.__setattr__(self, "_camera_from_world", motion)

    @classmethod
    def looking_at(
        cls,
        position: ArrayLike,
        target: ArrayLike,
        *,
        up: ArrayLike,
        field_of_view: float,
        width: int,
        height: int,
    ) -> "Camera":
        """A camera at ``position`` [m] that looks at ``target`` [m], with ``up`` pointing up in the picture.

        Args:
            position: The camera's centre in the world [m], shape (3,).
            target: The point in the middle of the picture [m], shape (3,).
            up: Direction in the world that points up in the picture, shape (3,).
            field_of_view: Vertical opening angle [rad].
            width: Picture width [px].
            height: Picture height [px].
        """
        position = np.asarray(position, dtype=np.float64)
        forward = _unit(np.asarray(target, dtype=np.float64) - position)
        right = _unit(np.cross(forward, np.asarray(up, dtype=np.float64)))
        rotation = np.column_stack([right, np.cross(forward, right), forward])
        focal = 0.5 * height / np.tan(0.5 * field_of_view)
        matrix = np.array(
            [[focal, 0.0, 0.5 * (width - 1)], [0.0, focal, 0.5 * (height - 1)], [0.0, 0.0, 1.0]]
        )
        return cls(width, height, matrix, Pose(position, rotation))

    def project(self, points: ArrayLike) -> Array:
        """Pixel positions of points in the world.

        Args:
            points: Points in the world [m], shape (..., 3), in front of the camera.

        Returns:
            Pixel positions (u, v) [px], shape (..., 2).
        """
        points = np.asarray(points, dtype=np.float64)
        seen = points @ self._camera_from_world[:, :3].T + self._camera_from_world[:, 3]
        return self.to_pixels(seen[..., :2] / seen[..., 2:])

    def to_pixels(self, rays: ArrayLike) -> Array:
        """Where rays land in the picture.

        Args:
            rays: Where they meet the plane one metre before the camera, in the camera's axes, shape (..., 2).

        Returns:
            Pixel positions (u, v) [px], shape (..., 2).
        """
        rays = np.asarray(rays, dtype=np.float64)
        if self.distortion.any():
            rays = distort(rays, self.distortion)
        return np.asarray(rays @ self.matrix[:2, :2].T + self.matrix[:2, 2])

    def to_rays(self, pixels: ArrayLike) -> Array:
        """Which rays land in pixels; undoes ``to_pixels``."""
        centred = np.asarray(pixels, dtype=np.float64) - self.matrix[:2, 2]
        rays = np.asarray(centred @ np.linalg.inv(self.matrix[:2, :2]).T)
        return undistort(rays, self.distortion) if self.distortion.any() else rays

    def to_plane(self, pixels: ArrayLike, z: float) -> Array:
        """Where the rays through pixels meet the horizontal plane at height ``z`` [m].

        Args:
            pixels: Pixel positions (u, v) [px], shape (..., 2).
            z: Height of the plane in the world [m].

        Returns:
            Positions (x, y) in the world [m], shape (..., 2).
        """
        rays = self.to_rays(pixels)
        ahead = np.concatenate([rays, np.ones((*rays.shape[:-1], 1))], axis=-1)
        rays = ahead @ self.world_from_camera.rotation.T
        depth = (z - self.world_from_camera.position[2]) / rays[..., 2:]
        return np.asarray(self.world_from_camera.position[:2] + depth * rays[..., :2])


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))
