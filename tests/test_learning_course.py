"""The improved generator: what it must recover exactly, and what it must leave alone."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.frame import Frame
from cobot_lfd.learning.course.course import fit_course
from cobot_lfd.learning.course.features import FeatureSet, scene_features
from cobot_lfd.learning.course.phase import (
    by_phase,
    common_progress,
    follow,
    way_despite_trembling,
    way_travelled,
)
from cobot_lfd.learning.course.scene_regression import fit_scene_regression
from cobot_lfd.learning.course.smoothing import read, readout
from cobot_lfd.learning.course.splines import even_basis, roughness_penalty
from cobot_lfd.learning.data import Scenes, TaskData, collect
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations, draw_scene, human_timing, planar
from cobot_lfd.learning.selection import select_frames
from cobot_lfd.learning.settings import IMPROVED


def random_scenes(n: int, seed: int, n_frames: int = 2) -> Scenes:
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-np.pi, np.pi, (n, n_frames))
    cos, sin = np.cos(angles), np.sin(angles)
    return Scenes(
        rng.normal(size=(n, n_frames, 2)), np.stack([np.stack([cos, -sin], -1), np.stack([sin, cos], -1)], -2)
    )


def made_of(scenes: Scenes, features: FeatureSet, shares: Array) -> Array:
    """Paths that are exactly sums of the scene's vectors."""
    return np.swapaxes(scene_features(scenes, features) @ shares, 1, 2) + scenes.positions[:, None, 0]


def test_paths_made_of_the_scenes_vectors_are_recovered() -> None:
    """Where the model is true, scenes metres across are predicted to a few millimetres."""
    u = np.linspace(0, 1, 200)
    shares = np.stack([u**2 * (3 - 2 * u), np.sin(np.pi * u) / 2, u * (1 - u), np.cos(u) - 1, -u * (1 - u)])
    features = FeatureSet((True, True), False, 1.0)
    scenes, new = random_scenes(8, 0), random_scenes(20, 1)
    fitted = fit_scene_regression(made_of(scenes, features, shares), scenes, features)
    assert_allclose(fitted.predict(new), made_of(new, features, shares), atol=4e-3)


def test_held_out_residuals_are_those_of_a_fit_without_the_demonstration() -> None:
    """The quick leave-one-out formula against fitting again with the same penalties."""
    data = collect(demonstrations(TASKS[2], 5, np.random.default_rng(0)))
    features = FeatureSet((True, False), False, 1.0)
    whole = fit_scene_regression(data.paths, data.scenes, features)
    vectors = scene_features(data.scenes, features)
    basis = even_basis(whole.coefficients.shape[1], 200)
    variance = whole.held_out.var()
    kept = [0, 1, 3, 4]
    weight = basis.T @ basis / 200 / variance
    penalty = whole.rough_weight * roughness_penalty(basis.shape[1], 3) / variance
    moments = np.einsum("ndf,ndg->fg", vectors[kept], vectors[kept])
    matrix = np.kron(moments, weight) + np.kron(np.eye(vectors.shape[2]), penalty)
    targets = data.paths[kept] - data.scenes.positions[kept, None, 0]
    right = np.einsum("ndf,ntd,tb->fb", vectors[kept], targets, basis) / 200 / variance
    shares = np.linalg.solve(matrix, right.ravel()).reshape(right.shape) @ basis.T
    predicted = (vectors[2] @ shares).T + data.scenes.positions[2, 0]
    ours = data.paths[2] - whole.held_out[2].T
    # Weights along the task differ between the two, so they agree only to the size of the noise.
    assert np.linalg.norm(ours - predicted, axis=1).mean() < 0.03


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 1000), st.floats(0.6, 1.6))
def test_way_and_phase_do_not_depend_on_speed(seed: int, power: float) -> None:
    """Running along the same curves faster or slower changes only where the samples lie."""
    rng = np.random.default_rng(seed)
    fine = np.linspace(0, 1, 2001)
    waves = np.stack([fine, fine**2, np.sin(3 * fine), np.cos(4 * fine)], axis=1)
    curves = waves @ rng.normal(size=(3, 4, 2))
    times = np.linspace(0, 1, 400) ** power
    hasty = np.stack([np.stack([np.interp(times, fine, c) for c in p.T], 1) for p in curves])
    none = np.zeros((3, 0), dtype=np.intp)
    steady = follow(curves, np.linspace(0, 1, 400))
    first, second = (by_phase(p, none, 0.3, 50).paths for p in (steady, hasty))
    size = way_travelled(curves)[:, -1].max()
    assert np.linalg.norm(first - second, axis=-1).mean() < 0.03 * size


def test_near_a_landmark_the_way_alone_counts() -> None:
    """Of straight ways of 1 m and of 2 m, the same phase is as far from the start, or from the end."""
    along = np.linspace(0, 1, 400)[:, None] * np.array([[1.0, 0.0]])
    told = by_phase(np.stack([along, 2 * along]), np.zeros((2, 0), dtype=np.intp), 0.4, 201).paths[..., 0]
    first, last = slice(0, 70), slice(131, 201)
    assert_allclose(told[0, first], told[1, first], atol=0.01)
    assert_allclose(1 - told[0, last], 2 - told[1, last], atol=0.01)
    assert (np.diff(told, axis=1) >= 0).all()


def test_progress_keeps_its_pace_at_the_ends() -> None:
    """Along a line at constant speed, smoothing over time does not slow the first and last steps."""
    line = np.linspace([0.0, 0.0], [1.0, 0.0], 200)[None]
    progress = common_progress(line, np.linspace(0, 1, 200)[None], line)
    assert_allclose(progress.mean, np.linspace(0, 1, 200), atol=1e-6)


def test_trembling_on_the_spot_is_no_way() -> None:
    rng = np.random.default_rng(0)
    wait = rng.normal(0, 0.003, (1, 300, 2))
    line = np.linspace([0.0, 0.0], [1.0, 0.0], 100)[None]
    path = np.concatenate([wait, line], axis=1)
    assert way_travelled(path)[0, 300] > 1.0
    assert way_despite_trembling(path)[0, 300] < 0.03
    assert way_despite_trembling(path)[0, -1] == pytest.approx(1.0, abs=0.03)


def test_landmarks_come_at_the_same_phase_in_all_demonstrations() -> None:
    data = collect(demonstrations(replace(TASKS[1], via=True), 4, np.random.default_rng(0)))
    passing = np.linalg.norm(data.local[:, 2], axis=-1).argmin(axis=-1)[:, None]
    told = by_phase(data.paths, passing, 0.3, 400).paths
    offsets = np.linalg.norm(told - data.scenes.positions[:, None, 2], axis=-1)
    places = offsets.argmin(axis=1)
    assert places.max() - places.min() <= 6


def test_following_evenly_is_even() -> None:
    curve = np.stack([np.linspace(0, 1, 50) ** 3, np.linspace(0, 1, 50)], axis=1)[None]
    steps = np.linalg.norm(np.diff(follow(curve, np.linspace(0, 1, 30)), axis=1), axis=-1)
    assert_allclose(steps, steps.mean(), rtol=0.02)


def test_smoothing_leaves_parabolas_alone() -> None:
    """They have no jerk."""
    t = np.linspace(0, 1, 200)
    parabola = np.stack([t, 1 - 3 * t + t**2], axis=1)
    smooth = read(readout(np.ones(200), 1e-2) @ parabola, 200)
    assert_allclose(smooth, parabola, atol=1e-4)


def test_a_smoothed_path_does_not_set_off_backwards() -> None:
    """A movement from rest to rest goes one way; smoothed as strongly as is ever tried, it still does."""
    u = np.linspace(0, 1, 200)
    movement = (10 * u**3 - 15 * u**4 + 6 * u**5)[:, None]
    smooth = read(readout(np.ones(200), 2e-6) @ movement, 200)
    assert np.diff(smooth[:, 0]).min() > -1e-4
    assert np.abs(smooth - movement).max() < 0.03


def test_the_jerk_penalty_is_the_integral() -> None:
    """Of t³ the third derivative is 6, so the integral of its square is 36."""
    basis = even_basis(20, 400)
    cubic = np.linalg.lstsq(basis, np.linspace(0, 1, 400) ** 3, rcond=None)[0]
    assert cubic @ roughness_penalty(20, 3) @ cubic == pytest.approx(36, rel=1e-6)


def selected(data: TaskData, oriented: list[bool]) -> list[str]:
    return [data.names[j] for j in select_frames(data, oriented)]


@pytest.mark.parametrize("seed", range(4))
def test_an_irrelevant_frame_is_dropped(seed: int) -> None:
    task = replace(TASKS[2], irrelevant=True)
    data = collect(demonstrations(task, 6, np.random.default_rng(seed)))
    assert selected(data, [True, False, False]) == ["start", "end"]


@pytest.mark.parametrize("seed", [0, 58, 74])
def test_none_of_many_frames_is_kept_because_one_of_them_helps_by_chance(seed: int) -> None:
    """In the last two of these, one of four would be kept if each had the whole chance of error."""
    rng = np.random.default_rng(seed)
    shown = [d for d in demonstrations(TASKS[1], 6, rng) if isinstance(d, Demonstration)]
    crowded = []
    for each in shown:
        others = {f"other{i}": Frame(rng.uniform(-1, 1, 2), rng.uniform(-3, 3)) for i in range(4)}
        crowded.append(Demonstration(each.path, {**each.frames, **others}, each.times))
    data = collect(crowded)
    assert selected(data, [True, True, False, False, False, False]) == ["start", "end"]


@pytest.mark.parametrize("seed", range(4))
def test_a_frame_that_is_passed_is_kept(seed: int) -> None:
    data = collect(demonstrations(replace(TASKS[1], via=True), 6, np.random.default_rng(seed)))
    assert selected(data, [True, True, False]) == ["start", "end", "via"]


def test_the_covariance_grows_in_scenes_unlike_the_demonstrated_ones() -> None:
    data = collect(demonstrations(TASKS[1], 6, np.random.default_rng(0)))
    course = fit_course(data, [True, True], IMPROVED.course)
    near = draw_scene(TASKS[1], np.random.default_rng(5))
    frames = [planar(near)[name] for name in data.names]
    positions = np.stack([f.position for f in frames])[None]
    rotations = np.stack([f.rotation for f in frames])[None]
    _, usual = course.generate(Scenes(positions, rotations), 50)
    _, wide = course.generate(Scenes(positions * 5, rotations), 50)
    assert np.trace(wide.sum(axis=(0, 1))) > 2 * np.trace(usual.sum(axis=(0, 1)))


def test_held_out_demonstrations_fall_within_the_predicted_covariance() -> None:
    """The squared Mahalanobis distance of new demonstrations is of the order of the dimension."""
    task = human_timing(TASKS[2])
    rng = np.random.default_rng(3)
    data = collect(demonstrations(task, 40, rng))
    course = fit_course(data.only(range(8)), [True, False], IMPROVED.course)
    mean, covariance = course.generate(data.scenes.only(range(8, 40)), 200)
    offset = (data.paths[8:] - mean)[..., None]
    squared = (np.swapaxes(offset, -1, -2) @ np.linalg.solve(covariance, offset))[..., 0, 0]
    assert 0.5 < np.median(squared) < 4
