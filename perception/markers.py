"""Finds ArUco markers: black and white squares with a number, the reference that people know."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame
from perception.picture import Picture, check_picture

_DICTIONARY = cv2.aruco.DICT_4X4_50
_CORNER_NOISE = 0.25  # Standard deviation of a corner's place at the least [px]; found by measuring.
_STEP = 1e-5  # For the derivative of the projection [m].


@dataclass(frozen=True, slots=True)
class Marker:
    """A marker that lies flat on something.

    Attributes:
        name: Name of the frame that it marks; the frame is in its middle, x to its right, y to its top.
        number: Its number in the dictionary of 4 x 4 markers, 0 to 49.
        size: Length of the black square's sides [m].
        z: Its height in the world [m].
    """

    name: str
    number: int
    size: float
    z: float

    @property
    def corners(self) -> Array:
        """Top left, top right, bottom right, bottom left in the marker's frame [m], shape (4, 2)."""
        return np.array([[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]) * self.size / 2


def marker_image(number: int, pixels_per_cell: int = 1) -> NDArray[np.uint8]:
    """A marker as it is printed, with its black border, 0 or 255, shape (6 n, 6 n)."""
    dictionary = cv2.aruco.getPredefinedDictionary(_DICTIONARY)
    return np.asarray(dictionary.generateImageMarker(number, 6 * pixels_per_cell), dtype=np.uint8)


def detect_markers(
    picture: Picture, camera: Camera, markers: Sequence[Marker]
) -> tuple[Detection | NotSeen, ...]:
    """Find markers in a picture.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        camera: The camera that took it.
        markers: What to look for.

    Returns:
        For each marker what was seen, or why not, in the markers' order.

    Raises:
        ValueError: If the picture is not one of this camera.
    """
    check_picture(picture, camera)
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(_DICTIONARY), parameters)
    corners, numbers, _ = detector.detectMarkers(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY))
    found: dict[int, Array] = {}
    if numbers is not None:
        for number, square in zip(np.ravel(numbers), corners, strict=True):
            found[int(number)] = np.asarray(square, dtype=np.float64).reshape(4, 2)
    return tuple(
        _detection(camera, marker, found[marker.number])
        if marker.number in found
        else NotSeen(marker.name, f"marker {marker.number} is not in the picture, or not legible.")
        for marker in markers
    )


def _detection(camera: Camera, marker: Marker, pixels: Array) -> Detection:
    frame = _rigid_fit(marker.corners, camera.to_plane(pixels, marker.z))
    return Detection(
        name=marker.name,
        frame=frame,
        symmetry=1,
        covariance=_covariance(camera, marker, frame, pixels),
        confidence=1.0,
        contour=pixels,
    )


def _rigid_fit(local: Array, world: Array) -> Frame:
    """The frame that takes points to where they were seen, by least squares."""
    a, b = local - local.mean(axis=0), world - world.mean(axis=0)
    angle = np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    turn = Frame(np.zeros(2), float(angle))
    return Frame(world.mean(axis=0) - turn.apply(local.mean(axis=0)), turn.angle)


def _covariance(camera: Camera, marker: Marker, frame: Frame, pixels: Array) -> Array:
    """Of the errors in x [m], y [m] and angle [rad], from how far the corners are off."""
    expected = _project(camera, marker, frame)
    columns = [
        (_project(camera, marker, Frame(frame.position + step[:2], frame.angle + step[2])) - expected).ravel()
        for step in _STEP * np.eye(3)
    ]
    jacobian = np.column_stack(columns) / _STEP
    variance = max(float(np.sum((pixels - expected) ** 2)) / (pixels.size - 3), _CORNER_NOISE**2)
    return np.asarray(np.linalg.inv(jacobian.T @ jacobian) * variance)


def _project(camera: Camera, marker: Marker, frame: Frame) -> Array:
    return camera.project(np.column_stack([frame.apply(marker.corners), np.full(4, marker.z)]))
