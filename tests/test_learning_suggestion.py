"""Suggesting the next demonstration."""

from collections.abc import Mapping

import numpy as np
import pytest

from cobot_lfd import TaskParameterisedGMM
from cobot_lfd.learning.data import TaskFrame
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrate, draw_scene, planar, true_path
from cobot_lfd.learning.suggestion import suggest_demonstration


def test_no_candidates_are_refused() -> None:
    demos = [demonstrate(TASKS[1], np.random.default_rng(i)) for i in range(3)]
    with pytest.raises(ValueError, match="candidates is empty"):
        suggest_demonstration(TaskParameterisedGMM.fit(demos), [], [])


def test_a_scene_unlike_all_others_tells_more_than_one_already_shown() -> None:
    rng = np.random.default_rng(0)
    demos = [demonstrate(TASKS[1], rng) for _ in range(5)]
    shown: list[Mapping[str, TaskFrame]] = [demo.frames for demo in demos]
    model = TaskParameterisedGMM.fit(demos)
    odd = {
        name: type(frame)(3 * frame.position, frame.angle + 2.0)
        for name, frame in planar(draw_scene(TASKS[1], rng)).items()
    }
    assert suggest_demonstration(model, [shown[0], odd, shown[1]], shown).index == 1


def test_suggested_scenes_teach_faster_than_random_ones() -> None:
    """After two more demonstrations the error in new scenes is smaller, median over training sets."""
    after: dict[bool, list[float]] = {False: [], True: []}
    for suggested, errors in after.items():
        for seed in range(5):
            rng = np.random.default_rng([1, seed])
            tried = [draw_scene(TASKS[1], rng) for _ in range(30)]
            demos = [demonstrate(TASKS[1], rng) for _ in range(3)]
            for _ in range(2):
                offered = [draw_scene(TASKS[1], rng) for _ in range(30)]
                frames = [planar(scene) for scene in offered]
                model = TaskParameterisedGMM.fit(demos)
                shown = [demo.frames for demo in demos]
                index = suggest_demonstration(model, frames, shown).index if suggested else 0
                demos.append(demonstrate(TASKS[1], rng, scene=offered[index]))
            model = TaskParameterisedGMM.fit(demos)
            paths = model.reproduce_many([planar(scene) for scene in tried])
            truth = [true_path(TASKS[1], scene) for scene in tried]
            apart = [np.linalg.norm(p.mean - t, axis=1).mean() for p, t in zip(paths, truth, strict=True)]
            errors.append(float(np.mean(apart)))
    assert np.median(after[True]) < np.median(after[False])
