"""Where the objects stand: drawn at random from the ranges that the scene gives, with room between them."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from cobot_lfd.errors import DescriptionError
from cobot_lfd.frame import Frame
from scenes.description import SceneDescription
from scenes.shapes import Placement

_MOST_ATTEMPTS = 10_000


def draw_placements(description: SceneDescription, generator: np.random.Generator) -> Mapping[str, Frame]:
    """A frame for every object: even over its ranges, given that all keep their distance.

    Args:
        description: The scene.
        generator: Where the chance comes from.

    Raises:
        DescriptionError: If the ranges leave no room for the distance that the objects must keep.
    """
    for _ in range(_MOST_ATTEMPTS):
        frames = {
            name: _draw(item.place, description.radius, generator)
            for name, item in description.objects.items()
        }
        if _keep_distance(list(frames.values()), description.centre_distance):
            return MappingProxyType(frames)
    raise DescriptionError(
        f"scene '{description.title}': {len(description.objects)} objects found no place "
        f"{description.centre_distance} m apart; widen their ranges or lower centre_distance."
    )


def _draw(place: Placement, radius: tuple[float, float], generator: np.random.Generator) -> Frame:
    """A frame from the ranges; one that varies keeps its distance from the robot's base."""
    for _ in range(_MOST_ATTEMPTS):
        x, y, angle_deg = (generator.uniform(*limits) for limits in (place.x, place.y, place.angle_deg))
        if place.is_fixed or radius[0] <= np.hypot(x, y) <= radius[1]:
            return Frame(np.array([x, y]), np.deg2rad(angle_deg))
    raise DescriptionError(f"x {place.x} and y {place.y} have no place {radius} m from the robot's base.")


def _keep_distance(frames: list[Frame], distance: float) -> bool:
    return all(
        np.linalg.norm(a.position - b.position) >= distance for i, a in enumerate(frames) for b in frames[:i]
    )
