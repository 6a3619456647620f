"""What stands out from the table in one picture: connected regions of one colour that is not the table's."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from perception.discovery.palette import label_colours
from perception.picture import Picture, check_picture
from perception.region import Region
from perception.table import table_colour

_SMALLEST = 60  # Pixels of a region; fewer tell neither size nor outline.
_EVERY = 5  # Pixels from one to the next where a part of them is enough.


@dataclass(frozen=True, slots=True, eq=False)
class Thing:
    """A region that stands out from the table.

    Attributes:
        region: Its hull, middle, area and colour.
        mask: Which pixels of its bounding box belong to it, shape (height, width).
        corner: Column and row of the bounding box's first pixel, shape (2,).
        table: The table's colour in the same picture, red, green, blue in 0..255, shape (3,).
    """

    region: Region
    mask: NDArray[np.bool_]
    corner: NDArray[np.int_]
    table: Array


def propose(picture: Picture, camera: Camera) -> tuple[Thing, ...]:
    """The things that stand out from the table, the largest first; none if the picture is too dark.

    Colours are compared by their shares of red, green and blue, which a shadow does not change; so a shadow
    is no thing, and neither is what has the table's own colour.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        camera: The camera that took it.

    Raises:
        ValueError: If the picture is not one of this camera.
    """
    check_picture(picture, camera)
    table = table_colour(picture.reshape(-1, 3)[::_EVERY].astype(np.float64))
    if table is None:
        return ()
    labels = label_colours(picture, table)
    things = [thing for i in range(labels.max() + 1) for thing in _things(picture, labels == i, table)]
    return tuple(sorted(things, key=lambda thing: -thing.region.area))


def whole(picture: Picture, thing: Thing) -> Thing:
    """All that hangs together with a thing and has not the table's colour, whatever colours it has."""
    mask = (label_colours(picture, thing.table) >= 0).astype(np.uint8)
    opened = cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    contours, _ = cv2.findContours(opened, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    rows, columns = thing.mask.shape
    x, y = thing.corner
    best = np.zeros_like(mask), 0
    for contour in contours:
        part = np.zeros_like(mask)
        cv2.drawContours(part, [contour], -1, 1, cv2.FILLED)
        common = int(part[y : y + rows, x : x + columns][thing.mask].sum())
        best = max(best, (part, common), key=lambda item: item[1])
    return next(iter(_things(picture, best[0] > 0, thing.table)), thing)


def _things(picture: Picture, mask: NDArray[np.bool_], table: Array) -> list[Thing]:
    """The connected parts of a mask, without what is thinner than three pixels."""
    opened = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    count, labels, stats, centroids = cv2.connectedComponentsWithStats(opened, connectivity=8)
    things = []
    for i in range(1, count):
        x, y, width, height, area = (int(value) for value in stats[i])
        if area < _SMALLEST:
            continue
        box = np.s_[y : y + height, x : x + width]
        part = np.asarray(labels)[box] == i
        region = Region(
            hull=_hull(part, x, y),
            centroid=np.asarray(centroids[i], dtype=np.float64),
            area=float(area),
            colour=_typical_colour(picture[box], part),
            at_border=x == 0 or y == 0 or x + width == mask.shape[1] or y + height == mask.shape[0],
        )
        things.append(Thing(region, part, np.array([x, y]), table))
    return things


def _hull(part: NDArray[np.bool_], x: int, y: int) -> Array:
    rows, columns = np.nonzero(part)
    points = np.column_stack([columns + x, rows + y]).astype(np.float32)
    return np.asarray(cv2.convexHull(points)[:, 0], dtype=np.float64)


def _typical_colour(pixels: Picture, part: NDArray[np.bool_]) -> Array:
    """Median colour, without the mixed pixels at the border where there are others."""
    core = cv2.erode(part.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=0) > 0
    return np.asarray(np.median(pixels[core if core.any() else part], axis=0), dtype=np.float64)
