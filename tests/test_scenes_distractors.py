"""Distractors: seen, not known, and nothing else of the scene changes for them."""

import numpy as np
import pytest

from cobot_lfd.app.perceive import perceive
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DescriptionError
from scenes import SceneDescription, World, load_scene

pytestmark = pytest.mark.simulator

SCENE = load_scene("pick_and_place")


def with_distractors(n: int) -> SceneDescription:
    return SCENE.model_copy(update={"distractors": n})


def positions(world: World, bodies: tuple[int, ...]) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.array([world.client.getBasePositionAndOrientation(body)[0] for body in bodies])


def test_the_objects_stand_where_they_would_without_distractors() -> None:
    with World(SCENE, 7) as plain, World(with_distractors(6), 7) as full:
        for name, frame in plain.true_frames().items():
            assert full.true_frames()[name].position.tobytes() == frame.position.tobytes()
        assert not np.array_equal(plain.take_picture(), full.take_picture())


def test_the_same_seed_gives_the_same_distractors_and_another_one_others() -> None:
    scene = with_distractors(4)
    with World(scene, 7) as one, World(scene, 7) as same, World(scene, 8) as other:
        assert np.array_equal(one.take_picture(), same.take_picture())
        assert not np.allclose(positions(one, one.distractors), positions(other, other.distractors))


@pytest.mark.parametrize("seed", range(5))
def test_they_lie_in_the_picture_away_from_the_objects_and_stay_there(seed: int) -> None:
    with World(with_distractors(5), seed) as world:
        before = positions(world, world.distractors)
        camera = SCENE.camera.camera
        pixels = camera.project(before)
        assert ((pixels > 0) & (pixels < [camera.width, camera.height])).all()
        for frame in world.true_frames().values():
            apart = np.linalg.norm(before[:, :2] - frame.position, axis=1)
            assert apart.min() >= SCENE.centre_distance
        for _ in range(100):
            world.step()
        np.testing.assert_allclose(positions(world, world.distractors), before, atol=1e-3)  # [m]


@pytest.mark.parametrize("seed", range(3))
def test_what_is_looked_for_is_found_among_them(seed: int) -> None:
    with World(with_distractors(5), seed) as world:
        view = perceive(world)
        assert {seen.name for seen in view.detections} == {"cube", "container"}
        for name in ("cube", "container"):
            seen = view.find(name)
            assert isinstance(seen, Detection)
            true = world.true_frames()[name].position
            np.testing.assert_allclose(seen.frame.position, true, atol=2e-3)  # [m]


def test_too_many_are_told() -> None:
    crowded = with_distractors(20).model_copy(update={"centre_distance": 0.4})
    with pytest.raises(DescriptionError, match="20 distractors find no place on the table; ask for fewer"):
        World(crowded, 0)
