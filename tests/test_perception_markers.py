"""Markers are found where they lie, told apart by their numbers, and not invented."""

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame, wrap_angle
from cobot_lfd.marker import N_MARKERS, Marker, marker_image
from cobot_lfd.pose import Pose
from perception import MarkerDetector
from perception.picture import Picture
from scenes.prints import Print, draw_prints

CAMERA = Camera.looking_at(
    [0.5, 0.0, 1.2], [0.5, 0.0, 0.0], up=[1, 0, 0], field_of_view=0.5, width=640, height=480
)
TABLE = np.full((480, 640, 3), 170, dtype=np.uint8)
MARKERS = (Marker("left", 3, 0.05, 0.04), Marker("right", 17, 0.08, 0.0))


def picture_of(frames: dict[str, Frame]) -> Picture:
    prints = []
    for marker in MARKERS:
        image = np.pad(marker_image(marker.number, 10), 10, constant_values=255)
        size = marker.size * 80 / 60
        frame = frames[marker.name]
        prints.append(
            Print(image, size, size, Pose.from_rpy([*frame.position, marker.z], [0, 0, frame.angle]))
        )
    return draw_prints(TABLE, CAMERA, prints, np.full(TABLE.shape[:2], 1.2))


def frames_of(seed: int) -> dict[str, Frame]:
    generator = np.random.default_rng(seed)
    return {
        "left": Frame(generator.uniform([0.4, 0.08], [0.6, 0.2]), generator.uniform(-3.0, 3.0)),
        "right": Frame(generator.uniform([0.4, -0.2], [0.6, -0.08]), generator.uniform(-3.0, 3.0)),
    }


def errors(detection: Detection | NotSeen, truth: Frame) -> Array:
    assert isinstance(detection, Detection), detection
    off = detection.frame.position - truth.position
    return np.array([*off, wrap_angle(detection.frame.angle - truth.angle)])


def test_markers_are_found_where_they_lie_with_their_whole_angle() -> None:
    for seed in range(10):
        for found in MarkerDetector(MARKERS).detect(picture_of(frames_of(seed)), CAMERA):
            off = errors(found, frames_of(seed)[found.name])
            assert np.linalg.norm(off[:2]) < 1e-3
            assert abs(off[2]) < np.deg2rad(2.5)


def test_the_covariance_tells_how_far_off_markers_are() -> None:
    normalised = []
    for seed in range(10):
        for found in MarkerDetector(MARKERS).detect(picture_of(frames_of(seed)), CAMERA):
            assert isinstance(found, Detection)
            off = errors(found, frames_of(seed)[found.name])
            normalised.append(off @ np.linalg.solve(found.covariance, off))
    assert 0.3 < np.mean(normalised) < 9.0


def test_the_contour_is_that_of_the_ink() -> None:
    found = MarkerDetector(MARKERS).detect(picture_of(frames_of(0)), CAMERA)[0]
    assert isinstance(found, Detection)
    corners = np.column_stack([frames_of(0)["left"].apply(MARKERS[0].corners), np.full(4, 0.04)])
    assert_allclose(found.contour, CAMERA.project(corners), atol=1.0)  # [px]


def test_a_marker_that_is_not_there_is_not_seen() -> None:
    seen = MarkerDetector((Marker("other", 5, 0.05, 0.0), *MARKERS)).detect(picture_of(frames_of(0)), CAMERA)
    assert seen[0] == NotSeen("other", "marker 5 is not in the picture, or not legible.")
    assert all(isinstance(found, Detection) for found in seen[1:])


def test_an_empty_table_shows_no_marker() -> None:
    assert all(isinstance(found, NotSeen) for found in MarkerDetector(MARKERS).detect(TABLE, CAMERA))


def test_a_picture_of_another_size_is_told() -> None:
    with pytest.raises(ValueError, match=r"the picture has shape \(100, 100, 3\); the camera's have shape"):
        MarkerDetector(MARKERS).detect(TABLE[:100, :100], CAMERA)


@pytest.mark.parametrize("number", range(N_MARKERS))
def test_markers_look_as_opencv_draws_them(number: int) -> None:
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    assert_array_equal(marker_image(number, 3), dictionary.generateImageMarker(number, 18))


def test_a_marker_beyond_the_dictionary_is_told() -> None:
    with pytest.raises(ValueError, match=r"marker 'cap' has number 50; it must be 0 to 49"):
        Marker("cap", 50, 0.05, 0.0)
