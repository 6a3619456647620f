"""Three dimensions: the same code, the same truths."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from cobot_lfd import Pose, SpatialDemonstration, TaskParameterisedGMM
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations, draw_scene, true_path

MOTION = Pose(np.array([0.3, -0.2, 1.0]), Rotation.from_euler("z", 1.1).as_matrix())


@pytest.mark.parametrize("method", ["improved", "paper", "conventional"])
def test_spatial_paths_move_with_their_frames(method: str) -> None:
    task = replace(TASKS[2], dimension=3)
    model = TaskParameterisedGMM.fit(demonstrations(task, 5, np.random.default_rng(0)), method=method)
    scene = draw_scene(task, np.random.default_rng(1))
    here = model.reproduce(scene)
    there = model.reproduce({name: MOTION @ frame for name, frame in scene.items()})
    assert_allclose(there.mean, MOTION.apply(here.mean), atol=1e-8)
    assert there.covariance.shape == (200, 3, 3)


def test_the_improved_method_beats_the_papers_in_space() -> None:
    task = replace(TASKS[1], dimension=3)
    rng = np.random.default_rng(2)
    demos = demonstrations(task, 6, rng)
    scenes = [draw_scene(task, rng) for _ in range(20)]
    truth = np.stack([true_path(task, scene) for scene in scenes])
    errors = {}
    for method in ("improved", "paper"):
        paths = TaskParameterisedGMM.fit(demos, method=method).reproduce_many(scenes)
        errors[method] = np.linalg.norm(np.stack([p.mean for p in paths]) - truth, axis=-1).mean()
    assert errors["improved"] < 0.5 * errors["paper"]


def test_a_planar_task_in_space_gives_the_planar_path() -> None:
    """Demonstrations on the table, told in space, predict the same path on the table."""
    planar_demos = demonstrations(TASKS[2], 6, np.random.default_rng(3))
    spatial = []
    for demo in planar_demos:
        frames = {
            name: Pose(
                np.append(frame.position, 0.0),
                np.block([[frame.rotation, np.zeros((2, 1))], [np.zeros((1, 2)), np.eye(1)]]),
            )
            for name, frame in demo.frames.items()
        }
        spatial.append(SpatialDemonstration(np.column_stack([demo.path, np.zeros(200)]), frames))
    model = TaskParameterisedGMM.fit(planar_demos)
    kinds = dict(model.frame_kinds)
    path = TaskParameterisedGMM.fit(spatial, frame_kinds=kinds).reproduce(spatial[0].frames)
    expected = model.reproduce(planar_demos[0].frames)
    assert_allclose(path.mean[:, 2], 0, atol=1e-9)
    assert np.linalg.norm(path.mean[:, :2] - expected.mean, axis=1).mean() < 0.03
