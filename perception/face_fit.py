"""The pose of a face whose look is known, fitted to the brightness of all its pixels in a picture."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from perception.blurred_picture import BlurredPicture
from perception.face import BLURS, Face
from perception.face_state import FaceState
from perception.rigid import on_plane
from perception.robust import robust_deviation, tukey_weights

_N_STEPS = 6  # At each blur, at the most.
_SMALL_STEP = 0.003  # From which on no further step is taken [px].
_LEAST_NOISE = 2.0  # Of brightness, in any case [0..255].
_LEAST_WEIGHT = 0.2  # From here on a pixel counts as one that shows the face.
_N_EVEN = (4, 4, 6)  # Unknowns at each blur where the light is even; at first it is a factor only.
_N_ALL = 8
_FEWEST_PIXELS = 60
_LEAST_INSIDE = 0.3  # Share of a face's pixels that must lie in the picture.
_RIDGE = 1e-3 * np.eye(_N_ALL)  # Keeps what no pixel tells anything about where it is.
_DARK = 20.0  # Brightness below which a ratio tells little [0..255].
# Where the light is taken to be uneven, which explains much, a face must be like the expected one in this
# share of its pixels, with this correlation.
_SHOWN_IN_SHADE, _CORRELATION_IN_SHADE = 0.8, 0.9


@dataclass(frozen=True, slots=True, eq=False)
class FaceFit:
    """A pose and how well the picture supports it.

    Attributes:
        frame: The pose.
        covariance: Of the errors in x [m], y [m] and angle [rad], shape (3, 3).
        shown: Share of the face's pixels that look as they should.
        correlation: Of the brightness of those, expected and seen, but for what the noise takes from it.
    """

    frame: Frame
    covariance: Array
    shown: float
    correlation: float


def fit_face(picture: BlurredPicture, face: Face, start: Frame) -> FaceFit | None:
    """Move a face until its pixels look as they are expected to look.

    Gauss-Newton on the differences of brightness, with the face's own gradients as in inverse compositional
    alignment (Baker and Matthews 2004), for the pose together with the light and the picture's blur; Tukey's
    weights leave out what covers the face. At first the light is taken to be even; where uneven light
    explains all of the face better, and not what covers it, that counts.

    Args:
        picture: The picture.
        face: The face.
        start: Where it is, to a few pixels.

    Returns:
        The fit; None if the face leaves the picture, or too little of it is seen.
    """
    try:
        state = _first(picture, face, start)
        for i, free in enumerate(_N_EVEN):
            state = _settled(picture, face, state, i, free)
        even = _judged(picture, face, state, _N_EVEN[-1])
        shaded = _judged(picture, face, _settled(picture, face, state, len(BLURS) - 1, _N_ALL), _N_ALL)
    except _OutOfViewError:
        return None
    return shaded if _explains_more(shaded, even) else even


class _OutOfViewError(Exception):
    """The face leaves the picture, or too little of it is seen."""


def _explains_more(shaded: FaceFit, even: FaceFit) -> bool:
    """Whether uneven light explains a face, and not what covers it, which would be like it in shape only."""
    least = max(even.correlation, _CORRELATION_IN_SHADE)
    return shaded.shown > _SHOWN_IN_SHADE and shaded.correlation > least


def _first(picture: BlurredPicture, face: Face, start: Frame) -> FaceState:
    """The start in a light that seems right, an even factor."""
    state = FaceState(start, np.array([1.0, 0.0, 0.0, 0.0, 0.0]))
    seen, usable = _seen(picture, face, state, 0)
    ratios = seen[usable] / np.maximum(state.expected(face.levels[0])[usable], _DARK)
    return replace(state, light=state.light * float(np.median(ratios)))


def _settled(picture: BlurredPicture, face: Face, state: FaceState, i: int, free: int) -> FaceState:
    """The state that explains the picture at its i-th blur best."""
    level = face.levels[i]
    small = _SMALL_STEP * BLURS[i] / BLURS[-1] * face.metres_per_pixel
    for _ in range(_N_STEPS):
        seen, usable = _seen(picture, face, state, i)
        errors = seen - state.expected(level)
        jacobian = state.jacobian(level, free)
        weighted = jacobian * _weights(errors, usable)[:, None]
        information = weighted.T @ jacobian + _RIDGE[:free, :free]
        step: Array = -np.asarray(np.linalg.solve(information, weighted.T @ errors), np.float64)
        moved = state.moved(step)
        state, before = moved.through_the_right_lens(), state
        if np.abs(step[:3] * [1.0, 1.0, face.radius]).max() < small and state.lens == before.lens:
            break
    return state


def _seen(picture: BlurredPicture, face: Face, state: FaceState, i: int) -> tuple[Array, NDArray[np.bool_]]:
    """Brightness of the picture at its i-th blur where a face's pixels land, and which count, (n,) each."""
    camera, level = picture.camera, face.levels[i]
    x, y = camera.project(on_plane(state.frame.apply(level.local), face.z)).astype(np.float32).T
    sampled = cv2.remap(
        picture.levels[i], x[:, None], y[:, None], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    undisturbed = level.looks[state.lens].undisturbed
    usable = (x >= 0) & (y >= 0) & (x <= camera.width - 1) & (y <= camera.height - 1) & undisturbed
    if usable.sum() < max(_LEAST_INSIDE * undisturbed.sum(), 1):
        raise _OutOfViewError
    return np.asarray(sampled, np.float64).ravel(), usable


def _weights(errors: Array, usable: NDArray[np.bool_]) -> Array:
    """Tukey's biweight, shape (n,); 0 for what does not count."""
    scale = max(robust_deviation(errors[usable]), _LEAST_NOISE)
    return np.where(usable, tukey_weights(errors, scale), 0.0)


def _judged(picture: BlurredPicture, face: Face, state: FaceState, free: int) -> FaceFit:
    """How well a pose is supported by the least blurred picture.

    The covariance is the sandwich ``H^-1 (sum over blocks of g g') H^-1`` (Huber 1967): it takes the errors
    as they are, also where those of neighbouring pixels hang together. Since the fit makes errors smaller
    than they are, they count as n / (n - p) for n blocks and p unknowns (MacKinnon and White 1985); and since
    a few blocks tell little of each unknown, half of it is the mean over all unknowns.
    """
    level = face.levels[-1]
    seen, usable = _seen(picture, face, state, len(BLURS) - 1)
    expected = state.expected(level)
    errors = seen - expected
    weights = _weights(errors, usable)
    shown = weights > _LEAST_WEIGHT
    if shown.sum() < _FEWEST_PIXELS:
        raise _OutOfViewError
    light = np.column_stack([np.ones(len(seen)), level.across])[:, : 1 if free < _N_ALL else 3]
    jacobian = state.jacobian(level, free)
    weighted = jacobian * weights[:, None]
    pulls = np.stack([np.bincount(level.blocks, pull) for pull in (weighted * errors[:, None]).T], axis=1)
    information = weighted.T @ jacobian + _RIDGE[:free, :free]
    inverse = np.linalg.inv(information)
    n_blocks = len(np.unique(level.blocks[shown]))
    spread = pulls.T @ pulls * n_blocks / max(n_blocks - free, 1)
    spread = 0.5 * (spread + float(np.trace(inverse @ spread)) / free * information)
    covariance = (inverse @ spread @ inverse)[:3, :3] + np.diag(face.least_error**2)
    return FaceFit(
        state.frame,
        covariance,
        shown=float(shown.sum() / level.looks[state.lens].undisturbed.sum()),
        correlation=_correlation(expected[shown], seen[shown], light[shown], picture.noise)
        if state.shows_the_face
        else 0.0,
    )


def _correlation(expected: Array, seen: Array, light: Array, noise: float) -> float:
    """Of two series of values, the second of which is noisy, as it would be without (Spearman 1904).

    What the light does to both, a plane over the face at the most, is no likeness and is taken off before.
    It is 0 where one of them is even, or shows no more than noise.
    """
    both = np.column_stack([expected, seen])
    a, b = (both - light @ np.linalg.solve(light.T @ light, light.T @ both)).T
    variance = float(b @ b) - len(b) * noise**2
    if variance <= 0.0:
        return 0.0
    return float(min(1.0, a @ b / max(float(np.linalg.norm(a)) * variance**0.5, 1e-9)))
