"""The made-up tasks do what they say."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd import Demonstration, SpatialDemonstration
from cobot_lfd.learning.experiments.synthetic import (
    TASKS,
    SyntheticTask,
    demonstrate,
    demonstrations,
    draw_scene,
    human_timing,
    paper_like,
    true_path,
)
from cobot_lfd.learning.metrics import path_length, shortest_distance


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("number", [1, 2, 3])
def test_paths_start_and_end_at_their_frames(number: int, dimension: int) -> None:
    task = replace(TASKS[number], dimension=dimension)
    scene = draw_scene(task, np.random.default_rng(0))
    path = true_path(task, scene)
    assert path.shape == (200, dimension)
    assert_allclose(path[0], scene["start"].position[:dimension], atol=1e-12)
    assert_allclose(path[-1], scene["end"].position[:dimension], atol=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_an_oriented_frame_is_left_along_its_x_axis(dimension: int) -> None:
    task = replace(TASKS[1], dimension=dimension)
    scene = draw_scene(task, np.random.default_rng(1))
    path = true_path(task, scene)
    within = np.linalg.norm(path - path[0], axis=1) < task.slot
    offsets = (path[within] - path[0]) @ scene["start"].rotation[:dimension]
    assert within.sum() > 10
    assert_allclose(offsets[:, 1:], 0, atol=1e-9)
    assert (offsets[1:, 0] > 0).all()


def test_a_via_frame_is_passed() -> None:
    task = replace(TASKS[1], via=True)
    scene = draw_scene(task, np.random.default_rng(2))
    nearest = np.linalg.norm(true_path(task, scene) - scene["via"].position[:2], axis=1).min()
    assert nearest < 0.01


def test_the_same_seed_gives_the_same_demonstrations() -> None:
    sets = [demonstrations(TASKS[1], 2, np.random.default_rng(3)) for _ in range(2)]
    assert_allclose(sets[0][1].path, sets[1][1].path, atol=0)


def test_without_a_demonstrators_variation_a_demonstration_is_the_truth() -> None:
    task = SyntheticTask(bow=0.0, warp=0.0, noise=(1e-9, 1e-9))
    scene = draw_scene(task, np.random.default_rng(4))
    demo = demonstrate(task, np.random.default_rng(5), scene=scene)
    assert_allclose(demo.path, true_path(task, scene), atol=1e-7)


def test_path_lengths_are_near_the_papers() -> None:
    """Table 4 holds 2.1 to 2.3, 1.4 to 1.7 and 1.0 to 1.3 for Tasks 1, 2 and 3."""
    expected = {1: (1.8, 2.5), 2: (1.4, 1.8), 3: (1.0, 1.05)}
    for number, (low, high) in expected.items():
        task = paper_like(TASKS[number])
        rng = np.random.default_rng(0)
        paths = np.stack([true_path(task, draw_scene(task, rng)) for _ in range(200)])
        assert low <= np.mean(path_length(paths) / shortest_distance(paths)) <= high


def test_a_human_waits_at_both_ends() -> None:
    task = human_timing(TASKS[3])
    path = true_path(task, draw_scene(task, np.random.default_rng(0)))
    assert_allclose(path[:16], path[:1].repeat(16, axis=0), atol=1e-9)
    assert_allclose(path[-16:], path[-1:].repeat(16, axis=0), atol=1e-9)


def test_planar_and_spatial_tasks_give_their_own_sort_of_demonstration() -> None:
    rng = np.random.default_rng(0)
    assert isinstance(demonstrate(TASKS[1], rng), Demonstration)
    assert isinstance(demonstrate(SyntheticTask(dimension=3), rng), SpatialDemonstration)
