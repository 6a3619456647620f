"""Symmetries of the whole method, for tasks of every sort."""

import warnings

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from cobot_lfd import Demonstration, Frame, TaskParameterisedGMM
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations, draw_scene, planar

seeds = st.integers(0, 10_000)
methods = st.sampled_from(["improved", "paper", "conventional"])
tasks = st.sampled_from([1, 2, 3])


def training_set(task: int, seed: int) -> list[Demonstration]:
    made = demonstrations(TASKS[task], 4, np.random.default_rng(seed), n_steps=60)
    return [demo for demo in made if isinstance(demo, Demonstration)]


def fit(demos: list[Demonstration], method: str) -> TaskParameterisedGMM:
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="component")
        return TaskParameterisedGMM.fit(demos, method=method)


@settings(max_examples=4, deadline=None)
@given(seeds, tasks, methods, st.floats(-3, 3), st.floats(-2, 2))
def test_it_does_not_matter_where_the_demonstrations_were_recorded(
    seed: int, task: int, method: str, angle: float, shift: float
) -> None:
    """Moving a whole demonstration, path and frames, changes nothing that is learnt."""
    demos = training_set(task, seed)
    motion = Frame(np.array([shift, 1.0]), angle)
    moved = [
        Demonstration(motion.apply(demo.path), {name: motion @ frame for name, frame in demo.frames.items()})
        for demo in demos
    ]
    scene = planar(draw_scene(TASKS[task], np.random.default_rng(seed + 1)))
    first, second = fit(demos, method), fit(moved, method)
    assert first.frame_kinds == second.frame_kinds
    assert_allclose(second.reproduce(scene).mean, first.reproduce(scene).mean, atol=1e-5)


@settings(max_examples=4, deadline=None)
@given(seeds, tasks, methods)
def test_the_order_of_the_demonstrations_does_not_matter(seed: int, task: int, method: str) -> None:
    demos = training_set(task, seed)
    scene = planar(draw_scene(TASKS[task], np.random.default_rng(seed + 1)))
    first, second = fit(demos, method), fit(demos[::-1], method)
    assert_allclose(second.reproduce(scene).mean, first.reproduce(scene).mean, atol=1e-5)


@settings(max_examples=4, deadline=None)
@given(seeds, tasks, st.floats(0.01, 100))
def test_the_unit_of_length_does_not_matter(seed: int, task: int, unit: float) -> None:
    demos = training_set(task, seed)
    scaled = [
        Demonstration(d.path * unit, {n: Frame(f.position * unit, f.angle) for n, f in d.frames.items()})
        for d in demos
    ]
    scene = planar(draw_scene(TASKS[task], np.random.default_rng(seed + 1)))
    large = {name: Frame(frame.position * unit, frame.angle) for name, frame in scene.items()}
    first, second = fit(demos, "improved").reproduce(scene), fit(scaled, "improved").reproduce(large)
    assert_allclose(second.mean / unit, first.mean, atol=1e-5)
    assert_allclose(second.covariance / unit**2, first.covariance, atol=1e-5)


@settings(max_examples=4, deadline=None)
@given(seeds, methods, st.floats(-3, 3), st.floats(-2, 2))
def test_moving_all_frames_moves_the_path(seed: int, method: str, angle: float, shift: float) -> None:
    model = fit(training_set(1, seed), method)
    scene = planar(draw_scene(TASKS[1], np.random.default_rng(seed + 1)))
    motion = Frame(np.array([shift, 1.0]), angle)
    there = model.reproduce({name: motion @ frame for name, frame in scene.items()}).mean
    assert_allclose(there, motion.apply(model.reproduce(scene).mean), atol=1e-8)
