"""A first guess of an object's pose from the region that has its colour."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from perception.region import Region
from perception.silhouette import corners_in_world

_ANGLE_STEP = np.deg2rad(5.0)
_N_DIRECTIONS = 48
_MOST_POSES = 3
_MOST_COVERED = 12
_SAME_ANGLE, _SAME_PLACE = 2, 8.0  # Steps and distance [px] within which two poses are one start.
_BEYOND = (
    4.0  # Where the region reaches beyond the shape counts that many times more than where it falls short.
)
_N_PUSHES = 12
_N_REWEIGHTINGS = 8
_AGREEMENT = 3.0  # Difference in reach up to which two shapes agree [px].
_N_TIMES_WORSE = 2.0  # A pose that fits this many times worse than the best one is not worth a try.


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """A region compared with an object's image at all angles.

    Two convex shapes are the same if they reach equally far in every direction (their support functions
    agree).

    Attributes:
        excess: How much farther the region reaches than the object at each of m angles, in each of n
            directions [px], shape (m, n); direction k + n / 2 is opposite to direction k.
        angles: The angles [rad], shape (m,).
        normals: The directions, unit vectors in the picture, shape (n, 2).
        reach: How far the region reaches from its middle at the most [px].
        start: Where the object was put, column and row [px], shape (2,).
        z: Height of the object's outline [m].
        camera: The camera.
    """

    excess: Array
    angles: Array
    normals: Array
    reach: float
    start: Array
    z: float
    camera: Camera

    @classmethod
    def of(cls, region: Region, model: ObjectModel, camera: Camera, scale: int) -> "Comparison":
        """Compare.

        Args:
            region: What has the object's colour.
            model: The object.
            camera: The camera.
            scale: Side of the squares of pixels that the region was found in [px].
        """
        directions = np.linspace(0.0, 2 * np.pi, _N_DIRECTIONS, endpoint=False)
        normals = np.column_stack([np.cos(directions), np.sin(directions)])
        reach = (region.hull @ normals.T).max(axis=0) + 0.5 * scale
        middle = camera.to_plane(region.centroid, 0.5 * (model.z + model.base_z.min()))
        angles = np.arange(0.0, 2 * np.pi / model.symmetry - 1e-9, _ANGLE_STEP)
        corners = _turned(corners_in_world(model, Frame(np.zeros(2), 0.0)), angles, middle)
        return cls(
            excess=reach - (camera.project(corners) @ normals.T).max(axis=1),
            angles=angles,
            normals=normals,
            reach=float(np.max(reach - normals @ region.centroid)),
            start=camera.project([*middle, model.z]),
            z=model.z,
            camera=camera,
        )

    @property
    def too_wide(self) -> float:
        """How far the region must stick out of the object's image, wherever that is and however turned [px].

        What is wider by w in some direction sticks out by w / 2 at one end at least. What the step from angle
        to angle may hide is taken off.
        """
        opposite = np.roll(self.excess, len(self.normals) // 2, axis=1)
        wider = 0.5 * (self.excess + opposite).max(axis=1)
        return float(wider.min() - _ANGLE_STEP * self.reach)

    def poses(self, *, covered: bool = False) -> list[Frame]:
        """The poses in which the object's image is most like the region, the likeliest first.

        At each angle the image is moved to where it agrees best.

        Args:
            covered: Whether a part of the object may be covered, so that the region reaches less far.
        """
        shifts, misfits = (_align_covered if covered else _align)(self.excess, self.normals)
        return [
            Frame(self.camera.to_plane(self.start + shifts[i, j], self.z), float(self.angles[i]))
            for i, j in _likeliest(shifts, misfits, _MOST_COVERED if covered else _MOST_POSES)
        ]


def _likeliest(shifts: Array, misfits: Array, most: int) -> list[tuple[int, int]]:
    """Which of m angles with k shifts each, shape (m, k, 2), have the least misfit, and differ enough."""
    n_angles, chosen = len(misfits), list[tuple[int, int]]()
    for flat in np.argsort(misfits, axis=None, kind="stable"):
        i, j = divmod(int(flat), misfits.shape[1])
        if misfits[i, j] > _N_TIMES_WORSE * misfits.min() or len(chosen) == most:
            break
        if all(
            min((i - a) % n_angles, (a - i) % n_angles) > _SAME_ANGLE
            or np.linalg.norm(shifts[i, j] - shifts[a, b]) > _SAME_PLACE
            for a, b in chosen
        ):
            chosen.append((i, j))
    return chosen


def _turned(corners: Array, angles: Array, middle: Array) -> Array:
    """Corners of shape (n, 3) at each of m angles about the vertical, then moved by ``middle``, (m, n, 3)."""
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x, y, z = corners.T
    x, y = cos * x - sin * y + middle[0], sin * x + cos * y + middle[1]
    return np.stack([x, y, np.broadcast_to(z, x.shape)], axis=-1)


def _align(excess: Array, normals: Array) -> tuple[Array, Array]:
    """The shift at each of m angles that makes two shapes agree best, (m, 1, 2), and the misfit left, (m, 1).

    Args:
        excess: How much farther the one shape reaches than the other, shape (m, n).
        normals: The directions, shape (n, 2).
    """
    shifts = excess @ np.linalg.pinv(normals).T
    return shifts[:, None], np.linalg.norm(excess - shifts @ normals.T, axis=1)[:, None]


def _align_covered(excess: Array, normals: Array) -> tuple[Array, Array]:
    """The same where a part may be covered: as many directions as possible agree, the others count little.

    From the shift that would agree best if nothing were covered, the shape is pushed to where it agrees in
    one of k = 12 directions; each time the shift is improved with Geman and McClure's weights. What is left
    of a box often fits either end of it, so all shifts are returned, (m, k, 2), with their misfits, (m, k).
    """
    m, n = excess.shape
    first = _align(excess, normals)[0][:, 0]
    pushed = normals[:: n // _N_PUSHES]
    short = (excess - first @ normals.T)[:, :: n // _N_PUSHES]
    shifts = (first[:, None] + short[..., None] * pushed).reshape(-1, 2)
    excess = np.repeat(excess, len(pushed), axis=0)
    for _ in range(_N_REWEIGHTINGS):
        weights = 1.0 / (1.0 + ((excess - shifts @ normals.T) / _AGREEMENT) ** 2) ** 2
        matrices = np.einsum("mn,ni,nj->mij", weights, normals, normals) + 1e-6 * np.eye(2)
        pulls = np.einsum("mn,ni->mi", weights * excess, normals)
        shifts = np.linalg.solve(matrices, pulls[..., None])[..., 0]
    rest = excess - shifts @ normals.T
    costs = np.minimum(np.abs(rest), np.where(rest > 0.0, _BEYOND, 1.0) * _AGREEMENT).sum(axis=1)
    return shifts.reshape(m, -1, 2), costs.reshape(m, -1)
