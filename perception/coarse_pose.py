"""A first guess of an object's pose from the region that has its colour."""

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from perception.segmentation import Region
from perception.silhouette import corners_in_world

_ANGLE_STEP = np.deg2rad(5.0)
_N_DIRECTIONS = 48
_N_TIMES_WORSE = 2.0  # A pose that fits this many times worse than the best one is not worth a try.


def guess_poses(region: Region, model: ObjectModel, camera: Camera, scale: int, n: int) -> list[Frame]:
    """The poses in which the object's image is most like a region, the likeliest first.

    Two convex shapes are the same if they reach equally far in every direction (their support functions
    agree). The shape is compared at all angles, each time moved to where it agrees best.

    Args:
        region: What has the object's colour.
        model: The object.
        camera: The camera.
        scale: Side of the squares of pixels that the region was found in [px].
        n: How many poses to return at most.
    """
    directions = np.linspace(0.0, 2 * np.pi, _N_DIRECTIONS, endpoint=False)
    normals = np.column_stack([np.cos(directions), np.sin(directions)])
    reach = (region.hull @ normals.T).max(axis=0) + 0.5 * scale
    middle = camera.to_plane(region.centroid, 0.5 * (model.z + model.base_z))
    angles = np.arange(0.0, 2 * np.pi / model.symmetry - 1e-9, _ANGLE_STEP)
    corners = np.array([corners_in_world(model, Frame(middle, angle)) for angle in angles])
    excess = reach - (camera.project(corners) @ normals.T).max(axis=1)
    shifts = excess @ np.linalg.pinv(normals).T
    misfits = np.linalg.norm(excess - shifts @ normals.T, axis=1)
    frames = []
    lowest = _local_minima(misfits)
    likely = lowest[misfits[lowest] < _N_TIMES_WORSE * misfits[lowest[0]]]
    for i in likely[:n]:
        moved = camera.to_plane(camera.project([*middle, model.z]) + shifts[i], model.z)
        frames.append(Frame(moved, float(angles[i])))
    return frames


def _local_minima(values: Array) -> Array:
    """Indices of the values that are smaller than both neighbours around the circle, the smallest first."""
    lowest = np.flatnonzero((values <= np.roll(values, 1)) & (values <= np.roll(values, -1)))
    return np.asarray(lowest[np.argsort(values[lowest], kind="stable")])
