"""The simulated world: repeatable, seen as its camera says, and judged by its physics."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from cobot_lfd.arrays import Array
from cobot_lfd.outcome import Outcome, Verdict
from cobot_lfd.pose import Pose
from scenes import SceneDescription, World, check_success, load_scene, object_models
from scenes.boxes import blocks_of
from scenes.renderer import Renderer
from tests.renderers import RENDERERS

pytestmark = pytest.mark.simulator

SCENE = load_scene("pick_and_place")


def varied(**parts: dict[str, Any]) -> SceneDescription:
    """The scene with some values of some parts replaced."""
    values = SCENE.model_dump()
    for key, changes in parts.items():
        target = values if key in values else values["objects"]
        target[key] |= changes
    return SceneDescription.model_validate(values)


def put(world: World, name: str, offset: Array) -> None:
    """Put an object's centre relative to the container's frame."""
    pose = world.true_poses()["container"]
    world.client.resetBasePositionAndOrientation(
        world.bodies[name], pose.apply(offset).tolist(), pose.quaternion.tolist()
    )


def state_after(seed: int, n_steps: int) -> Array:
    with World(SCENE, seed) as world:
        for _ in range(n_steps):
            world.step()
        return np.concatenate([pose.position for pose in world.true_poses().values()])


def test_scene_and_seed_decide_everything() -> None:
    assert_array_equal(state_after(3, 50), state_after(3, 50))
    assert np.abs(state_after(3, 0) - state_after(4, 0)).max() > 0.01


def test_objects_stand_where_they_were_put_and_stay_there() -> None:
    with World(SCENE, 5) as world:
        before = world.true_frames()
        for _ in range(500):
            world.step()
        assert world.time == pytest.approx(1.0)
        for name, frame in world.true_frames().items():
            assert_allclose(frame.position, before[name].position, atol=5e-4)  # [m]
            assert abs(world.true_poses()[name].position[2]) < 5e-4


def test_a_container_is_hollow_and_as_large_as_described() -> None:
    container = SCENE.objects["container"]
    blocks = blocks_of(container)
    low = np.min([b.centre - b.half_size for b in blocks], axis=0)
    high = np.max([b.centre + b.half_size for b in blocks], axis=0)
    assert_allclose(high - low, [0.13, 0.10, 0.04], atol=1e-12)
    volume = sum(8 * np.prod(b.half_size) for b in blocks)
    assert volume == pytest.approx(0.13 * 0.10 * 0.04 - 0.12 * 0.09 * 0.037)
    middle = np.array([0.0, 0.0, 0.02])
    assert not any((np.abs(middle - b.centre) < b.half_size).all() for b in blocks)


def test_a_covered_camera_sees_nothing() -> None:
    with World(SCENE, 0) as world:
        assert not world.take_picture(covered=True).any()
        assert world.take_picture().any()


def centroid_of_red(picture: Array) -> Array:
    """Mean position of the red pixels, weighted by how red they are [px]."""
    redness = np.clip((picture[..., 0] - picture[..., 1]) / picture.max(axis=-1) - 0.4, 0.0, None)
    v, u = np.indices(redness.shape)
    return np.asarray([(u * redness).sum(), (v * redness).sum()] / redness.sum())


@pytest.mark.parametrize("samples", [1, 2])
@pytest.mark.parametrize("renderer", RENDERERS)
def test_picture_and_camera_agree_to_a_small_part_of_a_pixel(renderer: Renderer, samples: int) -> None:
    """The centroid of a flat plate's pixels is the projected middle of its top face.

    The camera looks straight down, so the face's image is a rectangle and the two centres are the same.
    """
    scene = varied(cube={"size": (0.1, 0.1, 0.001)}, camera={"samples": samples}, light={"shadow": False})
    generator, offsets = np.random.default_rng(0), []
    with World(scene, 0, renderer=renderer) as world:
        put(world, "container", np.array([0.0, 0.0, -0.1]))
        for _ in range(10):
            position = generator.uniform([0.4, -0.2], [0.6, 0.2])
            turn = Pose.from_rpy(np.zeros(3), [0.0, 0.0, generator.uniform(-3, 3)]).quaternion
            world.client.resetBasePositionAndOrientation(world.bodies["cube"], [*position, 0.0005], turn)
            centroid = centroid_of_red(world.take_picture().astype(float))
            offsets.append(centroid - scene.camera.camera.project([*position, 0.001]))
    assert_allclose(np.mean(offsets, axis=0), 0.0, atol=0.04)  # [px]


def test_pictures_have_the_described_size_and_repeat() -> None:
    scene = varied(camera={"width": 160, "height": 120})
    with World(scene, 0) as world:
        first, second = world.take_picture(), world.take_picture()
    assert first.shape == (120, 160, 3)
    assert first.dtype == np.uint8
    assert_array_equal(first, second)


def test_everything_is_in_the_picture_wherever_it_stands() -> None:
    """All corners of all outlines at all corners of their ranges land in the picture."""
    camera = SCENE.camera.camera
    for model in object_models(SCENE):
        place = SCENE.objects[model.name].place
        radius = np.linalg.norm(model.outline, axis=1).max()
        x, y = np.add(place.x, [-radius, radius]), np.add(place.y, [-radius, radius])
        pixels = camera.project([[a, b, model.z] for a in x for b in y])
        assert (pixels > 2).all()
        assert (pixels < [camera.width - 3, camera.height - 3]).all()


def test_outlines_are_those_of_the_described_objects() -> None:
    cube, container = object_models(SCENE)
    assert (cube.name, cube.symmetry, cube.z) == ("cube", 4, 0.04)
    assert (container.name, container.symmetry, container.z) == ("container", 2, 0.04)
    assert_allclose(np.ptp(cube.outline, axis=0), [0.04, 0.04])
    assert_allclose(np.ptp(container.outline, axis=0), [0.13, 0.10])
    assert_allclose(np.ptp(container.holes[0], axis=0), [0.12, 0.09])


def test_a_cube_at_rest_in_the_container_is_success() -> None:
    with World(SCENE, 1) as world:
        put(world, "cube", np.array([0.02, -0.01, 0.0235]))
        for _ in range(120):
            world.step()
        began = world.time
        assert check_success(world).outcome is Outcome.SUCCESS
        assert world.time - began == pytest.approx(0.5, abs=0.005)


def test_a_cube_on_the_table_is_no_success() -> None:
    with World(SCENE, 1) as world:
        verdict = check_success(world)
    assert verdict.outcome is Outcome.NOT_PLACED
    assert "mm outside the walls of the container" in verdict.sentence


def test_a_falling_cube_is_no_success() -> None:
    with World(SCENE, 1) as world:
        put(world, "cube", np.array([0.0, 0.0, 0.035]))
        for _ in range(5):
            world.step()
        verdict = check_success(world)
    assert verdict.outcome is Outcome.NOT_AT_REST
    assert "the cube moves at" in verdict.sentence


def test_a_cube_above_the_rim_is_no_success() -> None:
    with World(SCENE, 1) as world:
        put(world, "cube", np.array([0.0, 0.0, 0.2]))
        assert "above the rim" in check_success(world).sentence


def test_a_cube_that_is_held_is_no_success() -> None:
    """What touches the cube counts as the robot here: the container itself."""
    with World(SCENE, 1) as world:
        put(world, "cube", np.array([0.0, 0.0, 0.0235]))
        for _ in range(120):
            world.step()
        verdict = check_success(world, robot_bodies=[world.bodies["container"]])
    assert verdict == Verdict(Outcome.NOT_RELEASED, "the robot touches the cube")


@pytest.mark.parametrize("renderer", RENDERERS)
def test_the_simulator_prints_nothing(renderer: Renderer, capfd: pytest.CaptureFixture[str]) -> None:
    with World(SCENE, 0, renderer=renderer) as world:
        world.take_picture()
    assert capfd.readouterr().out == ""
