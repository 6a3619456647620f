"""Regions of the picture that have an object's colour, told from the table and from the other objects."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.detection import ObjectModel
from perception.brightness import noise_of
from perception.picture import Picture
from perception.region import Region, connected_regions
from perception.robust import robust_deviation
from perception.table import chromaticity, shares, table_colour

_LEAST_SHARE = (
    0.4  # Of the colour difference between table and object: from here on a pixel may be the object.
)
_MOST_DEVIATION = 0.6  # Of a pixel from the line between table and object, as a share of the difference.
_PALE = 0.1  # Colours whose shares differ less from the table's are told by their brightness, too.
_BRIGHTNESS_SPREAD = 0.2  # Of the logarithm of an object's brightness, because its faces are shaded.
_LEAST_BRIGHTER = 0.05  # Of the logarithm: what is that much brighter than the table is no shadow on it.
_MOST_UNLIKELY = 9.0  # Squared deviation from a pale object's colour, in spreads.
_EVERY = 5  # Pixels from one to the next where a part of them is enough.
_BLACK = 0.02  # No ground is darker.
_LEAST_NOISE = 0.7  # What rounding leaves at the least [0..255].
_N_NOISE = 5.0  # Standard deviations of the table's colour that never count as an object.


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """What the picture shows of a table and of objects.

    Attributes:
        table: The table's colour, red, green, blue in 0..255, shape (3,).
        regions: For each object the regions that have its colour, the largest first.
        scale: Side of the squares of pixels that were averaged before [px].
        noise: Standard deviation of the noise of the picture's pixels [0..255].
    """

    table: Array
    regions: tuple[tuple[Region, ...], ...]
    scale: int
    noise: float


def segment(picture: Picture, models: Sequence[ObjectModel], scale: int) -> Segmentation | None:
    """Find the regions of each object's colour; None if the picture is too dark.

    Colours are compared as differences from the table's colour, as it is in this picture: a mixture of table
    and object lies between the two, a shadow changes neither.

    Args:
        picture: The picture.
        models: The objects.
        scale: Side of the squares of pixels that are averaged first [px].
    """
    height, width = picture.shape[0] // scale, picture.shape[1] // scale
    whole = picture[: height * scale, : width * scale]
    small = cv2.resize(whole, (width, height), interpolation=cv2.INTER_AREA).astype(np.float64)
    pixels = small.reshape(-1, 3)
    table = table_colour(pixels[::_EVERY])
    if table is None:
        return None
    looks = [_expected(model, table) for model in models]
    different = list(dict.fromkeys(looks))
    labels = _label(pixels, table, different).reshape(height, width)
    of_look = {look: _regions(labels == i, small, scale, look, table) for i, look in enumerate(different)}
    return Segmentation(
        table, tuple(of_look[look] for look in looks), scale, max(_LEAST_NOISE, noise_of(picture[..., 1]))
    )


@dataclass(frozen=True, slots=True)
class _Look:
    """How an object's colour must look in a picture.

    Attributes:
        colour: Red, green, blue in 0..255; their sum means nothing where the brightness is not known.
        brightness: Logarithm of how much brighter than the table it must be; None where that is not known.
    """

    colour: tuple[float, float, float]
    brightness: float | None


def _expected(model: ObjectModel, table: Array) -> _Look:
    """An object's colour under the light that makes the table look as it does."""
    if model.ground is None:
        r, g, b = 255 * model.colour
        return _Look((r, g, b), None)
    r, g, b = table * model.colour / np.maximum(model.ground, _BLACK)
    return _Look((r, g, b), float(np.log((r + g + b) / table.sum())))


def _label(pixels: Array, table: Array, looks: Sequence[_Look]) -> NDArray[np.int_]:
    """For each pixel the number of the look that it has, or -1 for none, shape (n,)."""
    difference = shares(pixels) - shares(table)
    best = np.full(len(pixels), _MOST_DEVIATION)
    labels = np.full(len(pixels), -1)
    pale = []
    for i, look in enumerate(looks):
        expected = shares(np.array(look.colour)) - shares(table)
        if look.brightness is not None and np.linalg.norm(expected) < _PALE:
            pale.append((i, expected, look.brightness))
            continue
        expected /= expected @ expected
        share = difference @ expected
        noise = robust_deviation(share[::_EVERY])
        foreground = np.flatnonzero(share > max(_LEAST_SHARE, _N_NOISE * noise))
        across = np.abs(difference[foreground] @ [-expected[1], expected[0]])
        deviation = across / share[foreground]
        better = deviation < best[foreground]
        best[foreground[better]] = deviation[better]
        labels[foreground[better]] = i
    if pale:
        _label_pale(labels, pixels, difference, table, pale)
    return labels


def _label_pale(
    labels: NDArray[np.int_],
    pixels: Array,
    difference: Array,
    table: Array,
    pale: Sequence[tuple[int, Array, float]],
) -> None:
    """Label the pixels that are left and more like a pale object than like the table, in light or shadow."""
    rest = np.flatnonzero(labels < 0)
    brightness = np.log(np.maximum(pixels[rest].sum(axis=1), 1.0) / table.sum())
    noise = robust_deviation(difference[::_EVERY])
    best = np.full(len(rest), _MOST_UNLIKELY)
    for i, expected, expected_brightness in pale:
        spread = 0.4 * np.linalg.norm(expected) + noise
        off = np.linalg.norm(difference[rest] - expected, axis=1) / spread
        thing = off**2 + ((brightness - expected_brightness) / _BRIGHTNESS_SPREAD) ** 2
        off = np.linalg.norm(difference[rest], axis=1) / spread
        ground = off**2 + (np.maximum(brightness, 0.0) / _LEAST_BRIGHTER) ** 2
        better = (thing < best) & (thing < ground)
        best[better] = thing[better]
        labels[rest[better]] = i


def _unlikeness(colours: Array, look: _Look, table: Array) -> Array:
    """How far colours are from the expected one, compared with how far that is from the table's, (n,)."""
    origin, goal = chromaticity(table), chromaticity(np.array(look.colour))
    if look.brightness is None or np.linalg.norm(goal - origin) >= _PALE:
        colours = chromaticity(colours)
    else:
        origin, goal = table, np.array(look.colour)
    return np.asarray(np.linalg.norm(colours - goal, axis=-1) / np.linalg.norm(goal - origin))


def _regions(
    mask: NDArray[np.bool_], small: Array, scale: int, look: _Look, table: Array
) -> tuple[Region, ...]:
    """The connected parts of a mask, the largest first, those of another colour last."""
    found = connected_regions(mask, small, scale)
    if not found:
        return ()
    unlike = _unlikeness(np.array([region.colour for region in found]), look, table)
    found = [replace(region, unlikeness=float(off)) for region, off in zip(found, unlike, strict=True)]
    return tuple(sorted(found, key=lambda region: (not region.right_colour, -region.area)))
