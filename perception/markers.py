"""Finds ArUco markers: black and white squares with a number, the reference that people know."""

from dataclasses import dataclass

import cv2
import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame
from cobot_lfd.marker import Marker
from perception.picture import Picture, check_picture
from perception.rigid import on_plane, rigid_fit

_DICTIONARY = cv2.aruco.DICT_4X4_50
_CORNER_NOISE = 0.25  # Standard deviation of a corner's place at the least [px]; found by measuring.
_STEP = 1e-5  # For the derivative of the projection [m].


@dataclass(frozen=True, slots=True)
class MarkerDetector:
    """Finds markers.

    Attributes:
        markers: What to look for.
    """

    markers: tuple[Marker, ...]

    def detect(self, picture: Picture, camera: Camera) -> tuple[Detection | NotSeen, ...]:
        """For each marker what was seen in a picture, or why not, in the markers' order."""
        check_picture(picture, camera)
        found = _squares(picture)
        return tuple(
            _detection(camera, marker, found[marker.number])
            if marker.number in found
            else NotSeen(marker.name, f"marker {marker.number} is not in the picture, or not legible.")
            for marker in self.markers
        )


def _squares(picture: Picture) -> dict[int, Array]:
    """Number of each marker in a picture to its corners [px], shape (4, 2)."""
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(_DICTIONARY), parameters)
    corners, numbers, _ = detector.detectMarkers(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY))
    if numbers is None:
        return {}
    return {
        int(number): np.asarray(square, dtype=np.float64).reshape(4, 2)
        for number, square in zip(np.ravel(numbers), corners, strict=True)
    }


def _detection(camera: Camera, marker: Marker, pixels: Array) -> Detection:
    frame = rigid_fit(marker.corners, camera.to_plane(pixels, marker.z))
    return Detection(
        name=marker.name,
        frame=frame,
        symmetry=1,
        covariance=_covariance(camera, marker, frame, pixels),
        confidence=1.0,
        contour=pixels,
    )


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
    return camera.project(on_plane(frame.apply(marker.corners), marker.z))
