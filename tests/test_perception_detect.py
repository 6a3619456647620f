"""Objects are found where they are, in pictures of both renderers; what cannot be seen is said not to be."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from perception import detect
from perception.picture import Picture
from scenes.renderer import Renderer
from tests.perception_examples import CAMERA, MODELS, errors, shot
from tests.renderers import needs_egl

pytestmark = pytest.mark.simulator


def errors_of(picture: Picture, truth: dict[str, Frame]) -> Array:
    """Distance [m] and angle [rad] by which each object is off, shape (n, 2)."""
    off = np.array([errors(d, truth[d.name]) for d in detect(picture, CAMERA, MODELS)])
    return np.column_stack([np.linalg.norm(off[:, :2], axis=1), np.abs(off[:, 2])])


@pytest.mark.parametrize(("renderer", "n"), [("tiny", 20), pytest.param("egl", 4, marks=needs_egl)])
def test_objects_are_found_where_they_are(renderer: Renderer, n: int) -> None:
    off = np.concatenate([errors_of(s.picture, s.frames) for s in (shot(i, renderer) for i in range(n))])
    assert (np.median(off, axis=0) < [0.1e-3, np.deg2rad(0.15)]).all()
    assert (off < [1e-3, np.deg2rad(2.0)]).all()


def test_the_covariance_tells_how_far_off_a_pose_is() -> None:
    """The normalised error squared is near its degrees of freedom, neither far above nor far below."""
    normalised = []
    for seed in range(20):
        for d in detect(shot(seed).picture, CAMERA, MODELS):
            assert isinstance(d, Detection)
            off = errors(d, shot(seed).frames[d.name])
            normalised.append(off @ np.linalg.solve(d.covariance, off))
    assert 1.0 < np.mean(normalised) < 6.0


def test_the_angle_is_the_representative_of_its_symmetry() -> None:
    for seed in range(10):
        for d in detect(shot(seed).picture, CAMERA, MODELS):
            assert isinstance(d, Detection)
            assert -np.pi / d.symmetry < d.frame.angle <= np.pi / d.symmetry


def test_the_contour_is_that_of_the_top_face() -> None:
    cube = detect(shot(0).picture, CAMERA, MODELS)[0]
    assert isinstance(cube, Detection)
    corners = np.column_stack([shot(0).frames["cube"].apply(MODELS[0].outline), np.full(4, 0.04)])
    distances = np.linalg.norm(cube.contour[:, None] - CAMERA.project(corners), axis=-1)
    assert_allclose(distances.min(axis=1), 0.0, atol=0.5)  # [px]


def test_the_order_of_the_models_decides_nothing_but_the_order() -> None:
    forward, backward = detect(shot(1).picture, CAMERA, MODELS), detect(shot(1).picture, CAMERA, MODELS[::-1])
    for a, b in zip(forward, backward[::-1], strict=True):
        assert isinstance(a, Detection)
        assert isinstance(b, Detection)
        assert_allclose(a.frame.position, b.frame.position)


@pytest.mark.parametrize("cast", [(1.0, 0.85, 0.7), (0.75, 0.85, 1.0), (0.35, 0.35, 0.35)])
def test_a_colour_cast_or_dim_light_hardly_moves_anything(cast: tuple[float, float, float]) -> None:
    for seed in range(4):
        picture = np.rint(shot(seed).picture * np.array(cast)).astype(np.uint8)
        assert (errors_of(picture, shot(seed).frames) < [0.7e-3, np.deg2rad(2.0)]).all()


def test_noise_is_borne() -> None:
    generator = np.random.default_rng(0)
    for seed in range(4):
        noisy = shot(seed).picture + generator.normal(scale=8.0, size=shot(seed).picture.shape)
        picture = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
        assert (errors_of(picture, shot(seed).frames) < [1e-3, np.deg2rad(2.5)]).all()


def painted(picture: Picture, centre: Array, half_size: Array) -> Picture:
    """The picture with a grey rectangle painted over it."""
    low, high = (np.rint(centre + s * np.asarray(half_size)).astype(int) for s in (-1, 1))
    result = picture.copy()
    result[low[1] : high[1], low[0] : high[0]] = (90, 92, 95)
    return result


def test_a_covered_object_is_not_seen_and_the_other_is() -> None:
    centre = CAMERA.project([*shot(2).frames["cube"].position, 0.04])
    cube, container = detect(painted(shot(2).picture, centre, np.array([30, 30])), CAMERA, MODELS)
    assert cube == NotSeen("cube", "nothing in the picture has the colour of the cube.")
    assert isinstance(container, Detection)


@pytest.mark.parametrize("seed", range(6))
def test_a_mostly_covered_object_is_not_seen(seed: int) -> None:
    centre = CAMERA.project([*shot(seed).frames["cube"].position, 0.04])
    cover = painted(shot(seed).picture, centre + np.array([18, 0]), np.array([30, 40]))
    cube = detect(cover, CAMERA, MODELS)[0]
    assert isinstance(cube, NotSeen)
    assert "covered" in cube.reason


@pytest.mark.parametrize("shift", [6, 14, 20, 24, 28])
def test_a_half_covered_object_is_found_where_it_is_or_not_at_all(shift: int) -> None:
    """Whatever is covered, from whichever side, nothing is invented."""
    for seed in range(2):
        truth = shot(seed).frames["cube"]
        for direction in np.array([[1, 0], [-1, 0], [0, 1], [0, -1]]):
            centre = CAMERA.project([*truth.position, 0.04]) + shift * direction
            cube = detect(painted(shot(seed).picture, centre, np.array([22, 22])), CAMERA, MODELS)[0]
            if isinstance(cube, Detection):
                assert np.linalg.norm(errors(cube, truth)[:2]) < 3e-3


@pytest.mark.parametrize("seed", range(6))
def test_a_corner_may_be_covered(seed: int) -> None:
    container = shot(seed).frames["container"]
    corner = CAMERA.project([*container.apply(MODELS[1].outline[seed % 4]), 0.04])
    found = detect(painted(shot(seed).picture, corner, np.array([28, 28])), CAMERA, MODELS)[1]
    off = errors(found, container)
    assert np.linalg.norm(off[:2]) < 1e-3
    assert abs(off[2]) < np.deg2rad(1.0)


def cropped(camera: Camera, picture: Picture, left: int) -> tuple[Camera, Picture]:
    """What remains without the leftmost columns."""
    matrix = camera.matrix - np.array([[0, 0, left], [0, 0, 0], [0, 0, 0]])
    return replace(camera, width=camera.width - left, matrix=matrix), picture[:, left:]


def test_a_camera_with_a_part_of_the_picture_sees_the_same() -> None:
    camera, picture = cropped(CAMERA, shot(3).picture, 60)
    for part, whole in zip(
        detect(picture, camera, MODELS), detect(shot(3).picture, CAMERA, MODELS), strict=True
    ):
        assert isinstance(part, Detection)
        assert isinstance(whole, Detection)
        assert_allclose(part.frame.position, whole.frame.position, atol=0.2e-3)


@pytest.mark.parametrize("seed", range(4))
def test_an_object_that_is_cut_off_is_found_where_it_is_or_not_at_all(seed: int) -> None:
    truth = shot(seed).frames["cube"]
    middle = int(CAMERA.project([*truth.position, 0.04])[0])
    half, little = (
        detect(picture, camera, MODELS)[0]
        for camera, picture in (cropped(CAMERA, shot(seed).picture, middle + cut) for cut in (-4, 10))
    )
    assert isinstance(half, Detection)
    assert np.linalg.norm(errors(half, truth)[:2]) < 0.5e-3
    assert half.confidence < 0.7
    if isinstance(little, Detection):
        assert np.linalg.norm(errors(little, truth)[:2]) < 0.5e-3
    else:
        assert "cut off by the picture's edge" in little.reason


def test_an_object_that_is_not_there_is_not_seen() -> None:
    green = replace(MODELS[0], name="plant", colour=np.array([0.1, 0.7, 0.1]))
    seen = detect(shot(0).picture, CAMERA, [green, *MODELS])
    assert seen[0] == NotSeen("plant", "nothing in the picture has the colour of the plant.")
    assert all(isinstance(d, Detection) for d in seen[1:])


def test_the_right_colour_in_the_wrong_size_is_not_seen() -> None:
    big = replace(MODELS[0], outline=3 * MODELS[0].outline)
    small = detect(shot(0).picture, CAMERA, [big])[0]
    assert isinstance(small, NotSeen)
    assert "11 % of its size" in small.reason


def test_the_right_colour_and_size_in_the_wrong_shape_is_not_seen() -> None:
    cross = np.array(
        [
            [3, 1],
            [1, 1],
            [1, 3],
            [-1, 3],
            [-1, 1],
            [-3, 1],
            [-3, -1],
            [-1, -1],
            [-1, -3],
            [1, -3],
            [1, -1],
            [3, -1],
        ]
    )
    other = replace(MODELS[0], outline=0.0085 * cross, base_z=np.zeros(12))
    assert isinstance(detect(shot(0).picture, CAMERA, [other])[0], NotSeen)


def test_a_covered_camera_sees_nothing_and_says_why() -> None:
    seen = detect(np.zeros((480, 640, 3), dtype=np.uint8), CAMERA, MODELS)
    assert seen == tuple(NotSeen(m.name, "the picture is too dark; is the camera covered?") for m in MODELS)


def test_an_empty_table_shows_nothing() -> None:
    seen = detect(np.full((480, 640, 3), 180, dtype=np.uint8), CAMERA, MODELS)
    assert all(isinstance(d, NotSeen) for d in seen)


@pytest.mark.parametrize(
    ("picture", "message"),
    [
        (
            np.zeros((480, 640), dtype=np.uint8),
            r"has shape \(480, 640\); the camera's have shape \(480, 640, 3\)",
        ),
        (np.zeros((240, 320, 3), dtype=np.uint8), r"has shape \(240, 320, 3\)"),
        (np.zeros((0, 0, 3), dtype=np.uint8), r"has shape \(0, 0, 3\)"),
        (np.zeros((480, 640, 3)), r"holds float64; it must be an array of uint8"),
        (None, r"holds NoneType"),
    ],
)
def test_what_is_no_picture_of_the_camera_is_told(picture: Picture, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        detect(picture, CAMERA, MODELS)


def drawn(camera: Camera, model: ObjectModel, frame: Frame) -> Picture:
    """A flat object drawn on a grey-brown table, each pixel the mean of 5 x 5 points."""
    from matplotlib.path import Path as Polygon

    v, u = np.indices((5 * camera.height, 5 * camera.width))
    pixels = np.stack([u, v], axis=-1).reshape(-1, 2) / 5 - 0.4
    inside = Polygon(model.outline).contains_points(frame.localise(camera.to_plane(pixels, model.z)))
    share = inside.reshape(camera.height, 5, camera.width, 5).mean(axis=(1, 3))[..., None]
    colours: Array = share * model.colour + (1 - share) * np.array([0.7, 0.65, 0.55])
    return np.rint(255 * colours).astype(np.uint8)


@pytest.mark.parametrize("angle", [-2.5, -0.4, 0.3, 1.9, 3.1])
def test_an_outline_without_symmetry_tells_the_whole_angle(angle: float) -> None:
    corners = np.array([[0, 0], [6, 0], [6, 2], [2, 2], [2, 4], [0, 4]]) * 0.01 - [0.025, 0.015]
    model = ObjectModel(
        "bracket", corners, 0.0, np.array([0.8, 0.2, 0.1]), symmetry=1, base_z=np.zeros(len(corners))
    )
    camera = Camera.looking_at(
        [0.5, 0.1, 0.6], [0.5, 0.0, 0.0], up=[1, 0, 0], field_of_view=0.5, width=320, height=240
    )
    frame = Frame(np.array([0.47, 0.03]), angle)
    found = detect(drawn(camera, model, frame), camera, [model])[0]
    off = errors(found, frame)
    assert np.linalg.norm(off[:2]) < 0.05e-3
    assert abs(off[2]) < np.deg2rad(0.1)
