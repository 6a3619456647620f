"""The pose of an object whose outline is known, fitted to the edges in the picture."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from perception.edge_noise import EdgeNoise, weighted_step
from perception.edges import EdgeOffsets, measure_edges
from perception.mixture import Mixture
from perception.picture import Picture
from perception.robust import robust_deviation, tukey_weights
from perception.silhouette import Contour, silhouette_hull, visible_contour

# How far from the outline edges are looked for, step after step [px]. Far at first, to make up for a rough
# start; near at last, so that shadows and other edges nearby do not disturb. A few points do until then.
_REACHES, _LAST_REACH = (8.0, 4.0), 2.5
_NEAR = 1.0  # If no part of the outline moved farther [px], the start was not rough.
_COARSE_SPACING = 3.0  # Of those few points [px], or this part of a small object's width:
_COARSE_PART = 0.12
_SMALLEST_REACH = 2.0
_FEWEST_POINTS = 12
_SURELY_FOUND, _SURE_RESIDUAL = 0.93, 0.5  # Share of the outline and residual [px] beyond doubt.
_LEAST_WEIGHT = 0.2  # Of an edge, by Tukey's biweight, so that it counts as part of the outline.
_LEAST_SCALE = 0.25  # The spread that edges are allowed to have in any case [px].
_RIDGE = 1e-3 * np.eye(3)  # Keeps a direction that no edge tells anything about where it is.
_STEP = 1e-5  # For the derivative of the projection [m].


@dataclass(frozen=True, slots=True, eq=False)
class OutlineFit:
    """A pose and how well the picture supports it.

    Attributes:
        frame: The pose.
        covariance: Of the errors in x [m], y [m] and angle [rad], shape (3, 3).
        found: Share of the outline where the picture has an edge.
        empty: Share of the outline on both sides of which the picture shows the table.
        residual: Root mean square distance of the edges from the outline [px].
    """

    frame: Frame
    covariance: Array
    found: float
    empty: float
    residual: float


def quality(fit: "OutlineFit | _Aligned") -> float:
    """How well a fit is supported: much of the outline, found close to where it should be."""
    return fit.found / (0.1 + fit.residual)


@dataclass(frozen=True, slots=True, eq=False)
class _Measurement:
    """An outline at a pose, how it depends on the pose, and the edges that were found along it."""

    frame: Frame
    contour: Contour
    jacobian: Array
    edges: EdgeOffsets


@dataclass(frozen=True, slots=True, eq=False)
class _Aligned:
    """An outline that lies on the edges but for a last step, and which of them belong to it, shape (n,)."""

    seen: _Measurement
    chosen: NDArray[np.bool_]
    residual: float

    @property
    def found(self) -> float:
        return float(self.chosen.mean())

    @property
    def beyond_doubt(self) -> bool:
        return self.found > _SURELY_FOUND and self.residual < _SURE_RESIDUAL


def fit_outline(
    picture: Picture, camera: Camera, model: ObjectModel, mixture: Mixture, starts: Sequence[Frame]
) -> OutlineFit | None:
    """Move an object's outline until it lies on the edges in the picture.

    Gauss-Newton with Tukey's weights brings it there from each start, the later ones being tried only while
    no result is beyond doubt. The best takes a last step, which weighs the edges by how their errors hang
    together and also gives the covariance.

    Args:
        picture: The picture.
        camera: The camera that took it.
        model: The object.
        mixture: Tells the object from the table.
        starts: Where the object may be, to a few pixels.

    Returns:
        The best fit; None if there are too few edges near every start.
    """
    best: _Aligned | None = None
    for start in starts:
        aligned = _align(picture, camera, model, mixture, start)
        if aligned is not None and (best is None or quality(aligned) > quality(best)):
            best = aligned
        if best is not None and best.beyond_doubt:
            break
    return None if best is None else _finish(best, bias=mixture.table_error * _LAST_REACH)


def _align(
    picture: Picture, camera: Camera, model: ObjectModel, mixture: Mixture, start: Frame
) -> _Aligned | None:
    """The outline on the edges near a start; None if there are too few."""
    width = float(np.ptp(silhouette_hull(model, start, camera), axis=0).min())
    widest = max(0.3 * width, _SMALLEST_REACH)
    coarse = min(_COARSE_PART * width, _COARSE_SPACING)
    frame = start
    for reach in _REACHES:
        near = min(reach, widest)
        # Of a rounded outline's many short sides, few or none may be long enough for a coarse spacing.
        seen = _measure(picture, camera, model, mixture, frame, near, coarse) or _measure(
            picture, camera, model, mixture, frame, near
        )
        if seen is None:
            return None
        step = _robust_step(seen)[0]
        frame = _moved(frame, step)
        if np.abs(seen.jacobian @ step).max() < _NEAR:
            break
    seen = _measure(picture, camera, model, mixture, frame, min(_LAST_REACH, widest))
    if seen is None:
        return None
    step, chosen = _robust_step(seen)
    residuals = seen.edges.offsets[chosen] - seen.jacobian[chosen] @ step
    return _Aligned(seen, chosen, float(np.sqrt(np.mean(residuals**2))))


def _measure(
    picture: Picture,
    camera: Camera,
    model: ObjectModel,
    mixture: Mixture,
    frame: Frame,
    reach: float,
    spacing: float = 1.0,
) -> _Measurement | None:
    """The edges along the outline at a pose; None if there are too few."""
    contour = visible_contour(model, frame, camera, spacing)
    if len(contour.points) < _FEWEST_POINTS:
        return None
    edges = measure_edges(picture, mixture, contour, reach)
    if edges.valid.sum() < _FEWEST_POINTS:
        return None
    return _Measurement(frame, contour, _jacobian(contour, frame, camera), edges)


def _finish(aligned: _Aligned, bias: float) -> OutlineFit:
    """The last step: the edges that belong to the outline, weighted by their noise.

    Args:
        aligned: The outline and its edges.
        bias: How far light and shadow may displace an edge as a whole [px]: an edge's place is the sum of the
            shares of the object across it, so they are off by an error of the share times the way.
    """
    seen, chosen = aligned.seen, aligned.chosen
    noise = EdgeNoise.seen_in(seen.edges.mixed[chosen], aligned.residual**2, bias)
    step, covariance = weighted_step(
        seen.contour[chosen], seen.jacobian[chosen], seen.edges.offsets[chosen], noise, _RIDGE
    )
    return OutlineFit(
        _moved(seen.frame, step),
        covariance,
        found=aligned.found,
        empty=float(seen.edges.empty.mean()),
        residual=aligned.residual,
    )


def _moved(frame: Frame, step: Array) -> Frame:
    return Frame(frame.position + step[:2], frame.angle + step[2])


def _jacobian(contour: Contour, frame: Frame, camera: Camera) -> Array:
    """How far the outline moves outwards [px] by x [m], y [m] and angle [rad], shape (n, 3)."""
    moved = camera.project(contour.points + _STEP * np.eye(3)[:2, None])
    by_x, by_y = np.sum((moved - contour.pixels) * contour.normals, axis=2) / _STEP
    x, y = (contour.points[:, :2] - frame.position).T
    return np.column_stack([by_x, by_y, x * by_y - y * by_x])


def _robust_step(seen: _Measurement) -> tuple[Array, NDArray[np.bool_]]:
    """The step that brings the outline to the edges (Tukey's biweight), and which edges belong to it."""
    valid = seen.edges.valid
    jacobian, offsets = seen.jacobian[valid], seen.edges.offsets[valid]
    weights = np.ones(len(offsets))
    for _ in range(3):
        weighted = jacobian * weights[:, None]
        step = np.linalg.solve(weighted.T @ jacobian + _RIDGE, weighted.T @ offsets)
        residuals = offsets - jacobian @ step
        weights = tukey_weights(residuals, max(robust_deviation(residuals), _LEAST_SCALE))
    chosen = valid.copy()
    chosen[valid] = weights > _LEAST_WEIGHT
    return np.asarray(step, dtype=np.float64), chosen
