"""Names for things that nobody has named: their colour, and a number where that is not enough."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from cobot_lfd.arrays import Array

_COLOURS = {
    "red": (200, 30, 30),
    "orange": (230, 115, 20),
    "yellow": (230, 195, 30),
    "green": (30, 140, 55),
    "cyan": (40, 180, 190),
    "blue": (30, 65, 200),
    "purple": (125, 40, 150),
    "pink": (235, 130, 170),
    "brown": (115, 70, 40),
    "black": (12, 12, 12),
    "grey": (125, 125, 125),
    "white": (235, 235, 235),
}
"""Red, green and blue of pictures, 0..255."""


def names_of(colours: Sequence[Array]) -> tuple[str, ...]:
    """A name for each thing, no two the same.

    Args:
        colours: Red, green, blue in 0..255 of each, in the order in which equal names are numbered.
    """
    words = [_word(colour) for colour in colours]
    total, so_far = Counter(words), Counter[str]()
    names = []
    for word in words:
        so_far[word] += 1
        names.append(word if total[word] == 1 else f"{word}_{so_far[word]}")
    return tuple(names)


def _word(colour: Array) -> str:
    """The nearest colour that has a name; differences of shade count less than those of hue."""

    def distance(other: tuple[int, int, int]) -> float:
        a, b = np.asarray(colour, dtype=np.float64), np.array(other, dtype=np.float64)
        shade = float(a.mean() - b.mean())
        return float(np.linalg.norm(a - b - shade)) + 0.5 * abs(shade)

    return min(_COLOURS, key=lambda word: distance(_COLOURS[word]))
