"""The improved generator: the way by regression on the scene, its timing by the demonstrations."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.learning.course.features import FeatureSet
from cobot_lfd.learning.course.phase import Phases, Progress, by_phase, common_progress, follow
from cobot_lfd.learning.course.scene_regression import (
    MINIMUM_JERK,
    STRAIGHT_PARTS,
    Roughness,
    SceneRegression,
    fit_scene_regression,
)
from cobot_lfd.learning.course.smoothing import read, readout
from cobot_lfd.learning.data import Scenes, TaskData
from cobot_lfd.learning.warping import warp_together

N_PHASES = 200
"""Steps along the way."""
UNIT = 2.5
"""The task's size is this multiple of the paths' root mean square extent: about a straight path's length."""
REACH = 0.4
"""How far from a landmark the way alone counts (see ``phase``)."""
PHASE_TOLERANCE = 0.95
"""A simpler way of telling phase must predict better by this factor to be taken."""
JERK_WEIGHTS = (1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 2e-6, 5e-6)
"""Penalties on a generated path's jerk that are tried."""
JERK_TOLERANCE = 0.05
"""The strongest smoothing is taken that raises the held-out error by less than this part ..."""
JERK_SHIFT = 3.0
"""... and moves the path by less than this many standard deviations of the place, nearly everywhere, ..."""
JERK_PASSING = 0.003
"""... and keeps as close to the frames that it passes, but for this part of the task's size."""
SIGHT_ERRORS = 2.0
"""Lines of sight count where they help by more than so many standard errors."""
HOLD_RANGE = (1 / 9, 3.0)
"""Smoothing leaves sure places alone more than others, within these factors on the median variance."""
END_WEIGHT = 1e-4
"""The ends of a path are held where the regression puts them: their share of the others' variance."""
VISITED = 0.06
"""A frame is visited if every demonstration passes within this part of the task's size."""


class ToldBy(Enum):
    """What says which points of different demonstrations belong together."""

    WAY = "the way travelled from, and left to, the frames that are visited"
    TIME = "time"
    WARP = "time, warped so that the distances to the frames agree"


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """The way, and how it is travelled.

    Attributes:
        regression: The way through the scene.
        progress: Share of the way that is done over time.
        coefficients: From positions over time to the smooth path, shape (B, T).
        told_by: The chosen way of telling phase.
        jerk_weight: The chosen smoothing.
    """

    regression: SceneRegression
    progress: Progress
    coefficients: Array
    told_by: ToldBy
    jerk_weight: float

    def generate(self, scenes: Scenes, n_steps: int) -> tuple[Array, Array]:
        """Means [m], shape (S, T, d), and covariances [m²], shape (S, T, d, d)."""
        way = self.regression.predict(scenes)
        d = way.shape[-1]
        variance = np.broadcast_to(self.regression.variance[:, None], (*way.shape[:2], 1))
        course = follow(way, self.progress.mean, np.concatenate([way, variance], axis=-1))
        mean = read(self.coefficients @ course[..., :d], n_steps)
        return mean, self._covariance(scenes, course[..., d], mean)

    def notes(self) -> list[str]:
        """What was chosen, in sentences."""
        sight = "and along the lines of sight" if self.regression.features.sight else "and no lines of sight"
        return [
            f"Demonstrations are compared by {self.told_by.value}.",
            f"The path is made of the frames' origins, the oriented frames' axes {sight}.",
            f"Chosen by leaving demonstrations out: penalty on roughness {self.regression.rough_weight:g}, "
            f"on size {self.regression.size_weight:g}, on the jerk of generated paths {self.jerk_weight:g}.",
        ]

    def _covariance(self, scenes: Scenes, at_place: Array, mean: Array) -> Array:
        """What the place leaves open, more so in unlike scenes, and along the path what the timing does.

        Args:
            scenes: The scenes.
            at_place: Variance at the place of each time of the grid [m²], shape (S, T').
            mean: The generated paths, shape (S, T, d).
        """
        n_steps = mean.shape[1]
        times, grid = np.linspace(0, 1, n_steps), np.linspace(0, 1, at_place.shape[1])
        if n_steps != len(grid):
            low = np.minimum((times * (len(grid) - 1)).astype(int), len(grid) - 2)
            part = times * (len(grid) - 1) - low
            at_place = at_place[:, low] * (1 - part) + at_place[:, low + 1] * part
        motion = np.empty_like(mean)
        motion[:, 1:-1] = mean[:, 2:] - mean[:, :-2]
        motion[:, 0], motion[:, -1] = 2 * (mean[:, 1] - mean[:, 0]), 2 * (mean[:, -1] - mean[:, -2])
        speed = np.sqrt(np.einsum("std,std->st", motion, motion))
        length = speed.sum(axis=1, keepdims=True) / 2
        timing = np.interp(times, grid, self.progress.spread) * length
        ahead = motion * (timing / (speed + 1e-6 * length + np.finfo(float).tiny))[..., None]
        spread = self.regression.spread(scenes)[:, None]
        return np.asarray(at_place[..., None, None] * spread + ahead[..., :, None] * ahead[..., None, :])


@dataclass(frozen=True, slots=True)
class CourseSettings:
    """Which parts of the improved generator are used.

    Attributes:
        told_by: By what the demonstrations are compared; of several, leave-one-out chooses, and prefers the
            first ones.
        landmarks: Let frames that are passed on the way divide it.
        straighten: Make straight parts straight.
        smooth: Take out jerk.
    """

    told_by: tuple[ToldBy, ...] = (ToldBy.WAY, ToldBy.TIME)
    landmarks: bool = True
    straighten: bool = True
    smooth: bool = True

    def __post_init__(self) -> None:
        """Check."""
        if not self.told_by:
            raise ValueError(f"told_by is empty; choose of: {', '.join(way.name for way in ToldBy)}.")


def task_size(data: TaskData) -> float:
    """The length in which a task is measured [m]."""
    return UNIT * max(data.scale, 1e-6)


def fit_course(data: TaskData, oriented: Sequence[bool], settings: CourseSettings) -> Course:
    """Learn the way and its timing; what is chosen is chosen by leaving one demonstration out in turn.

    Args:
        data: The demonstrations, with the frames that count.
        oriented: Which of them are oriented.
        settings: Which parts to use.
    """
    features = FeatureSet(tuple(oriented), False, task_size(data))
    told_by, phases, regression, progress = _best_phases(data, features, settings)
    with_sight = FeatureSet(tuple(oriented), True, features.unit)
    if not all(oriented) and len(oriented) > 1:
        candidate = fit_scene_regression(phases.paths, data.scenes, with_sight)
        regression = candidate if _clearly_better(candidate, regression) else regression
    if settings.straighten:
        regression = fit_scene_regression(phases.paths, data.scenes, regression.features, STRAIGHT_PARTS)
    ways = _held_out_ways(phases, regression)
    weight, coefficients = _smoothing(ways, progress, regression, data, settings)
    return Course(regression, progress, coefficients, told_by, weight)


def held_out_errors(data: TaskData, oriented: Sequence[bool], roughness: Roughness = MINIMUM_JERK) -> Array:
    """Mean distance of each demonstration from what the others predict [m], shape (N,)."""
    features = FeatureSet(tuple(oriented), False, task_size(data))
    phases = by_phase(data.paths, no_landmarks(data), REACH, N_PHASES)
    regression = fit_scene_regression(phases.paths, data.scenes, features, roughness)
    return np.asarray(np.linalg.norm(regression.held_out, axis=1).mean(axis=1))


def no_landmarks(data: TaskData) -> NDArray[np.intp]:
    """No inner landmarks, shape (N, 0)."""
    return np.zeros((len(data.paths), 0), dtype=np.intp)


def inner_landmarks(data: TaskData) -> NDArray[np.intp]:
    """Steps at which each demonstration passes the frames on its way, in their order, shape (N, M)."""
    distance = np.linalg.norm(data.local, axis=-1)
    nearest = distance.argmin(axis=-1)
    step = np.median(nearest, axis=0) / (len(data.times) - 1)
    close = distance.min(axis=-1).max(axis=0) < VISITED * task_size(data)
    inner = [j for j in np.argsort(step) if close[j] and 0.1 < step[j] < 0.9]
    landmarks = nearest[:, inner]
    ordered = (np.diff(landmarks, axis=1) > 0).all() and (landmarks > 0).all()
    return landmarks if ordered and (landmarks < len(data.times) - 1).all() else no_landmarks(data)


def _best_phases(
    data: TaskData, features: FeatureSet, settings: CourseSettings
) -> tuple[ToldBy, Phases, SceneRegression, Progress]:
    """The way of telling phase that predicts the paths over time best."""
    landmarks = inner_landmarks(data) if settings.landmarks else no_landmarks(data)
    choices = settings.told_by
    if ToldBy.WAY in choices and landmarks.shape[1]:
        # A frame that is passed must be passed in new scenes too, whatever the mean error says.
        choices = (ToldBy.WAY,)
    best = None
    for told_by in choices:
        phases = _told(data, told_by, landmarks)
        regression = fit_scene_regression(phases.paths, data.scenes, features)
        progress = common_progress(data.paths, phases.shares, regression.predict(data.scenes))
        course = follow(_held_out_ways(phases, regression), progress.mean)
        error = _distance(course, data).mean()
        if best is None or error < PHASE_TOLERANCE * best[0]:
            best = error, told_by, phases, regression, progress
    assert best is not None, "told_by was checked not to be empty"
    return best[1:]


def _told(data: TaskData, told_by: ToldBy, landmarks: NDArray[np.intp]) -> Phases:
    """The demonstrations, brought to where they belong together."""
    if told_by is ToldBy.WAY:
        return by_phase(data.paths, landmarks, REACH, N_PHASES)
    over_time = by_phase(data.paths, no_landmarks(data), None, N_PHASES)
    if told_by is ToldBy.TIME:
        return over_time
    warped = by_phase(warp_together(data).paths, no_landmarks(data), None, N_PHASES)
    return Phases(warped.paths, over_time.shares)


def _clearly_better(candidate: SceneRegression, base: SceneRegression) -> bool:
    """Whether more vectors predict left-out demonstrations better than chance would let them."""
    floor = (0.01 * base.features.unit) ** 2
    gain = np.log((base.held_out**2).mean(axis=(1, 2)) + floor) - np.log(
        (candidate.held_out**2).mean(axis=(1, 2)) + floor
    )
    n = len(gain)
    return n > 2 and bool(gain.mean() > SIGHT_ERRORS * gain.std(ddof=1) / np.sqrt(n))


def _held_out_ways(phases: Phases, regression: SceneRegression) -> Array:
    """Each demonstration's way as predicted from the others [m], shape (N, U, d)."""
    return np.asarray(phases.paths - np.swapaxes(regression.held_out, 1, 2))


def _smoothing(
    ways: Array, progress: Progress, regression: SceneRegression, data: TaskData, settings: CourseSettings
) -> tuple[float, Array]:
    """The strongest smoothing that costs no accuracy, in general or at a place that matters, and its map."""
    weights = JERK_WEIGHTS if settings.smooth else JERK_WEIGHTS[:1]
    course = follow(ways, progress.mean)
    places = np.broadcast_to(regression.variance[:, None], (*ways.shape[:2], 1))
    variance = follow(ways, progress.mean, places)[..., 0]
    sureness = 1.0 / np.sqrt(variance)
    usual = np.exp(np.log(variance).mean(axis=0))
    hold = np.clip(usual / np.median(usual), *HOLD_RANGE)
    hold[[0, -1]] = END_WEIGHT
    maps = [readout(hold, weight) for weight in weights]
    smooth = [read(m @ course, len(data.times)) for m in maps]
    errors = [_distance(path, data).mean() for path in smooth]
    shifts = [np.quantile(np.linalg.norm(path - course, axis=-1) * sureness, 0.95) for path in smooth]
    allowed = min(errors) * (1 + JERK_TOLERANCE)
    passing = [_passing_distance(path, data) for path in smooth]
    closest = _passing_distance(course, data) + JERK_PASSING * task_size(data)
    good = [
        i
        for i in range(len(maps))
        if errors[i] <= allowed and shifts[i] <= JERK_SHIFT and (passing[i] <= closest).all()
    ]
    chosen = max(good, default=0)
    return weights[chosen], maps[chosen]


def _passing_distance(course: Array, data: TaskData) -> Array:
    """How close the paths come to each frame, mean over the demonstrations [m], shape (J,)."""
    offsets = course[:, None] - data.scenes.positions[:, :, None]
    return np.asarray(np.linalg.norm(offsets, axis=-1).min(axis=-1).mean(axis=0))


def _distance(course: Array, data: TaskData) -> Array:
    """Distance from the demonstrations, shape (N, T)."""
    return np.asarray(np.linalg.norm(course - data.paths, axis=-1))
