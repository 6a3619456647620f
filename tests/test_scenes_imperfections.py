"""Pictures as a real camera takes them: bent, blurred, noisy, in false colours; all as described."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from cobot_lfd.detection import Detection
from cobot_lfd.errors import CobotError
from perception import detect
from scenes import World, load_scene, object_models
from scenes.imperfections import ideal_camera, on_sensor, through_lens
from scenes.view import CameraDescription, Lens, Sensor
from tests.renderers import needs_egl

SCENE = load_scene("pick_and_place")
GREY = np.full((60, 80, 3), 100.0)
BENT = (-0.25, 0.08, 0.001, -0.002, 0.0)


def camera_with(**parts: object) -> CameraDescription:
    return CameraDescription.model_validate(SCENE.camera.model_dump() | parts)


def test_a_perfect_sensor_changes_nothing() -> None:
    assert_array_equal(on_sensor(GREY, Sensor(), np.random.default_rng(0)), GREY)


def test_noise_has_the_described_strength_and_no_bias() -> None:
    seen = on_sensor(GREY, Sensor(noise=5.0), np.random.default_rng(0))
    assert np.std(seen) == pytest.approx(5.0, rel=0.03)
    assert np.mean(seen) == pytest.approx(100.0, abs=0.2)


def test_exposure_and_cast_multiply_and_are_cut() -> None:
    sensor = Sensor(exposure=2.0, colour_cast=(1.0, 0.5, 1.5))
    assert_array_equal(on_sensor(GREY, sensor, np.random.default_rng(0))[0, 0], [200, 100, 255])


def test_blur_spreads_light_and_loses_none() -> None:
    camera = replace(SCENE.camera.camera, width=81, height=61)
    point = np.zeros((61, 81, 3), dtype=np.uint8)
    point[30, 40] = 255
    blurred = through_lens(point, camera, camera, Lens(blur=2.0))[..., 0]
    v, u = np.indices(blurred.shape)
    assert blurred.sum() == pytest.approx(255, rel=1e-3)
    assert (blurred * (u - 40) ** 2).sum() / blurred.sum() == pytest.approx(4.0, rel=0.02)
    assert (blurred * (v - 30)).sum() == pytest.approx(0.0, abs=1e-6)


def test_the_ideal_camera_sees_all_that_the_bent_one_sees() -> None:
    camera = camera_with(lens={"distortion": BENT}).camera
    ideal = ideal_camera(camera)
    corners = np.array([[0, 0], [639, 0], [639, 479], [0, 479]])
    seen = ideal.to_pixels(camera.to_rays(corners))
    assert (seen >= 0).all()
    assert (seen <= [ideal.width - 1, ideal.height - 1]).all()
    assert not ideal.distortion.any()


@pytest.mark.simulator
def test_through_a_bent_lens_objects_are_found_where_they_are() -> None:
    """The renderer's lens and the camera that perception is given are the same one."""
    bent = camera_with(lens={"distortion": BENT})
    with World(SCENE, 4) as world:
        truth = world.true_frames()
        picture, straight = world.take_picture(camera=bent), world.take_picture()
    assert np.abs(picture.astype(int) - straight).max() > 50
    for found in detect(picture, bent.camera, object_models(SCENE)):
        assert isinstance(found, Detection)
        assert_allclose(found.frame.position, truth[found.name].position, atol=0.3e-3)


@pytest.mark.simulator
def test_noise_is_new_in_every_picture_and_the_same_in_every_world() -> None:
    noisy = camera_with(sensor={"noise": 4.0}, width=64, height=48)
    pairs = []
    for _ in range(2):
        with World(SCENE, 4) as world:
            pairs.append((world.take_picture(camera=noisy), world.take_picture(camera=noisy)))
    assert_array_equal(pairs[0], pairs[1])
    assert (pairs[0][0] != pairs[0][1]).any()


@pytest.mark.simulator
@needs_egl
def test_a_picture_too_large_for_the_renderer_is_told() -> None:
    with (
        World(SCENE, 0, renderer="egl") as world,
        pytest.raises(CobotError, match=r"'egl' draws at most 1024 x 768 px; a picture of 1280 x 960 px"),
    ):
        world.take_picture(camera=camera_with(width=1280, height=960))


@pytest.mark.simulator
def test_objects_can_be_put_elsewhere() -> None:
    with World(SCENE, 0) as world, World(SCENE, 1) as other:
        for name, frame in other.true_frames().items():
            world.place(name, frame)
            assert_allclose(world.true_frames()[name].position, frame.position, atol=1e-9)
            assert world.true_frames()[name].angle == pytest.approx(frame.angle)
            assert abs(world.true_poses()[name].position[2]) < 1e-9
