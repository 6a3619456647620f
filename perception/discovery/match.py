"""Which regions of different pictures look like the same kind of thing: by colour, size and shape."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from perception.discovery.propose import Thing
from perception.table import shares

# Differences that count as one unit of unlikeness. Light, shadow and the walls that are seen or not make two
# pictures of one thing differ by less.
_SHARES, _BRIGHTNESS, _SIZE, _LENGTH = 0.06, 0.30, 0.30, 0.30
_UNLIKE = 1.0  # Mean unlikeness from where on two groups are two kinds.


@dataclass(frozen=True, slots=True, eq=False)
class Kind:
    """Regions that look alike.

    Attributes:
        members: For each picture the numbers of the regions of this kind.
    """

    members: tuple[tuple[int, ...], ...]

    @property
    def count(self) -> int:
        """How many things of the kind there are: as many as most pictures show."""
        counts = [len(numbers) for numbers in self.members if numbers]
        return int(np.bincount(counts).argmax())

    @property
    def n_seen(self) -> int:
        """In how many pictures there is at least one."""
        return sum(bool(numbers) for numbers in self.members)


def match(pictures: Sequence[Sequence[Thing]], camera: Camera) -> tuple[Kind, ...]:
    """Group the things of all pictures into kinds, those seen in most pictures first.

    Args:
        pictures: The things of each picture.
        camera: The camera.
    """
    places = [(n, i) for n, things in enumerate(pictures) for i in range(len(things))]
    if not places:
        return ()
    features = np.array([_features(pictures[n][i], camera) for n, i in places])
    groups = np.ones(1, int)
    if len(places) > 1:
        groups = fcluster(linkage(features, "average"), _UNLIKE, "distance")
    kinds = []
    for group in np.unique(groups):
        mine = [place for place, other in zip(places, groups, strict=True) if other == group]
        members = tuple(tuple(i for m, i in mine if m == n) for n in range(len(pictures)))
        kinds.append(Kind(members))
    return tuple(sorted(kinds, key=lambda kind: -kind.n_seen))


def _features(thing: Thing, camera: Camera) -> Array:
    """Colour, size and shape of a region, each in units of what counts as unlike."""
    region = thing.region
    corners = camera.to_plane(region.hull, 0.0).astype(np.float32)
    _, sides, _ = cv2.minAreaRect(corners)
    low, high = max(min(sides), 1e-4), max(max(sides), 1e-4)
    brightness = np.log((region.colour.mean() + 8.0) / (thing.table.mean() + 8.0))
    return np.array(
        [
            *(shares(region.colour) - shares(thing.table)) / _SHARES,
            brightness / _BRIGHTNESS,
            0.5 * np.log(low * high) / _SIZE,
            0.5 * np.log(high / low) / _LENGTH,
        ]
    )
