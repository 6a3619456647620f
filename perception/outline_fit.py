"""The pose of an object whose outline is known, fitted to the edges in the picture."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from perception.edges import TableShare, measure_edges
from perception.picture import Picture
from perception.silhouette import Contour, silhouette_hull, visible_contour

_FIRST_REACH, _LAST_REACH = (
    8.0,
    4.0,
)  # How far from the outline edges are looked for, at first and at last [px].
_N_ITERATIONS = 6
_FEWEST_POINTS = 12
_STEP = 1e-5  # For the derivative of the projection [m].


@dataclass(frozen=True, slots=True, eq=False)
class OutlineFit:
    """A pose and how well the picture supports it.

    Attributes:
        frame: The pose.
        covariance: Of the errors in x [m], y [m] and angle [rad], shape (3, 3).
        found: Share of the outline where the picture has an edge.
        residual: Root mean square distance of the edges from the outline [px].
    """

    frame: Frame
    covariance: Array
    found: float
    residual: float


def fit_outline(
    picture: Picture, camera: Camera, model: ObjectModel, share: TableShare, start: Frame
) -> OutlineFit | None:
    """Move an object's outline until it lies on the edges in the picture (Gauss-Newton, Tukey's weights).

    Args:
        picture: The picture.
        camera: The camera that took it.
        model: The object.
        share: Tells the table from the object.
        start: Where the object is, to a few pixels.

    Returns:
        The fit; None if there are too few edges near the start.
    """
    frame = start
    widest = 0.3 * float(np.ptp(silhouette_hull(model, start, camera), axis=0).min())
    for reach in np.minimum(np.linspace(_FIRST_REACH, _LAST_REACH, _N_ITERATIONS), max(widest, 2.0)):
        contour = visible_contour(model, frame, camera)
        edges = measure_edges(picture, share, contour, float(reach))
        valid = edges.valid
        if valid.sum() < _FEWEST_POINTS:
            return None
        jacobian = _jacobian(contour, frame, camera)[valid]
        step, weights = _robust_step(jacobian, edges.offsets[valid])
        frame = Frame(frame.position + step[:2], frame.angle + step[2])
    residuals = edges.offsets[valid] - jacobian @ step
    near = weights > 0.0
    return OutlineFit(
        frame,
        _covariance(jacobian[near], residuals[near]),
        found=float(near.sum() / len(valid)),
        residual=float(np.sqrt(np.mean(residuals[near] ** 2))),
    )


def _jacobian(contour: Contour, frame: Frame, camera: Camera) -> Array:
    """How far the outline moves outwards [px] by x [m], y [m] and angle [rad], shape (n, 3)."""
    by_x, by_y = (
        np.sum((camera.project(contour.points + _STEP * axis) - contour.pixels) * contour.normals, axis=1)
        / _STEP
        for axis in np.eye(3)[:2]
    )
    x, y = (contour.points[:, :2] - frame.position).T
    return np.column_stack([by_x, by_y, x * by_y - y * by_x])


def _robust_step(jacobian: Array, offsets: Array) -> tuple[Array, Array]:
    """The step that brings the outline to the edges, and the weight of each edge (Tukey's biweight)."""
    weights = np.ones(len(offsets))
    for _ in range(4):
        weighted = jacobian * weights[:, None]
        step = np.linalg.lstsq(weighted.T @ jacobian, weighted.T @ offsets, rcond=None)[0]
        residuals = offsets - jacobian @ step
        scale = max(1.4826 * float(np.median(np.abs(residuals))), 0.25)
        weights = np.clip(1.0 - (residuals / (4.685 * scale)) ** 2, 0.0, None) ** 2
    return np.asarray(step, dtype=np.float64), weights


def _covariance(jacobian: Array, residuals: Array) -> Array:
    variance = float(np.mean(residuals**2))
    return np.asarray(np.linalg.pinv(jacobian.T @ jacobian) * variance)
