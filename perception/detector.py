"""What every detector is: made for some objects, it says of each where a picture shows it, or why not."""

from collections.abc import Iterable
from typing import Protocol

from cobot_lfd.appearance import Appearance
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, DetectorKind, NotSeen, ObjectModel
from cobot_lfd.marker import Marker
from perception.feature_detector import FeatureDetector
from perception.markers import MarkerDetector
from perception.picture import Picture
from perception.shape_detector import ShapeDetector


class Detector(Protocol):
    """Finds the objects that it was made for."""

    def detect(self, picture: Picture, camera: Camera) -> tuple[Detection | NotSeen, ...]:
        """Find the objects in a picture.

        Args:
            picture: Red, green, blue, uint8, shape (height, width, 3).
            camera: The camera that took it.

        Returns:
            For each object its planar pose with covariance, confidence and symmetry, or why it was not seen.

        Raises:
            ValueError: If the picture is not one of this camera.
        """


def detector_for(kind: DetectorKind, models: Iterable[ObjectModel]) -> Detector:
    """The detector of a kind for some objects.

    Raises:
        ValueError: If an object lacks what this kind of detector needs.
    """
    match kind:
        case "shape":
            return ShapeDetector(tuple(models))
        case "marker":
            return MarkerDetector(tuple(_marker(model) for model in models))
        case "features":
            return FeatureDetector(tuple(_appearance(model) for model in models))


def _marker(model: ObjectModel) -> Marker:
    if model.marker is None:
        raise ValueError(f"'{model.name}' is to be found by a marker, but it has none; give its model one.")
    return model.marker


def _appearance(model: ObjectModel) -> Appearance:
    if model.appearance is None:
        raise ValueError(
            f"'{model.name}' is to be found by features, but nobody has seen it; give its model an "
            "appearance (perception.learn_appearance)."
        )
    return model.appearance


def detect(
    picture: Picture, camera: Camera, models: Iterable[ObjectModel]
) -> tuple[Detection | NotSeen, ...]:
    """Find objects in a picture, each by the detector that it names.

    Args:
        picture: Red, green, blue, uint8, shape (height, width, 3).
        camera: The camera that took it.
        models: What to look for.

    Returns:
        For each model what was seen, or why not, in the models' order.

    Raises:
        ValueError: If the picture is not one of this camera, or an object lacks what its detector needs.
    """
    models = tuple(models)
    found: dict[str, Detection | NotSeen] = {}
    for kind in dict.fromkeys(model.found_by for model in models):
        detector = detector_for(kind, [model for model in models if model.found_by == kind])
        found |= {item.name: item for item in detector.detect(picture, camera)}
    return tuple(found[model.name] for model in models)
