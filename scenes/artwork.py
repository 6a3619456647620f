"""What is printed on objects: circuit boards, labels and markers, drawn from a seed."""

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from cobot_lfd.description_file import DescriptionModel
from cobot_lfd.marker import MARKER_CELLS, N_MARKERS, marker_image

Artwork = NDArray[np.uint8]
"""Red, green, blue, shape (rows, columns, 3); y upwards is towards the first row."""

DOTS_PER_METRE = 4000
_MARKER_SHARE = 0.75  # Of a face's shorter side is a marker's black square; the rest is its white margin.
_PAPER, _INK = (240, 240, 236), (28, 28, 32)
_MASKS = ((18, 92, 52), (16, 60, 122), (120, 24, 34), (30, 32, 36))
_COPPER, _TIN, _CHIP, _LETTERS = 26, (196, 190, 176), (34, 34, 38), (232, 232, 226)
_LABELS = ((196, 60, 44), (38, 98, 160), (226, 152, 40), (64, 132, 84))


class CircuitBoard(DescriptionModel):
    """Chips, traces, pads and white letters on a coloured board.

    Attributes:
        seed: Decides what is where, and the colour.
    """

    kind: Literal["circuit_board"]
    seed: Annotated[int, Field(ge=0)] = 0


class Label(DescriptionModel):
    """A parcel's label: a coloured band, lines of words, a bar code.

    Attributes:
        seed: Decides what is where, and the colour.
    """

    kind: Literal["label"]
    seed: Annotated[int, Field(ge=0)] = 0


class MarkerPrint(DescriptionModel):
    """An ArUco marker in the middle, with a white margin.

    Attributes:
        number: Its number in the dictionary of 4 x 4 markers.
    """

    kind: Literal["marker"]
    number: Annotated[int, Field(ge=0, lt=N_MARKERS)]


PrintDescription = Annotated[CircuitBoard | Label | MarkerPrint, Field(discriminator="kind")]
"""What is printed on a face; the key ``kind`` says which."""


def draw_artwork(print_: PrintDescription, size: tuple[float, float]) -> Artwork:
    """What is printed on a face of this extent along x and y [m]; nothing else decides what it looks like."""
    rows, columns = _dots(size)
    match print_:
        case CircuitBoard():
            return _circuit_board(rows, columns, np.random.default_rng([print_.seed, 1]))
        case Label():
            return _label(rows, columns, np.random.default_rng([print_.seed, 2]))
        case MarkerPrint():
            return _marker(rows, columns, print_.number)


def marker_size(size: tuple[float, float]) -> float:
    """Length of the sides of the black square that is printed on a face of this extent [m]."""
    rows, columns = _dots(size)
    return min(size) * MARKER_CELLS * _marker_cell(rows, columns) / min(rows, columns)


def _dots(size: tuple[float, float]) -> tuple[int, int]:
    """Rows and columns of what is printed on a face of this extent along x and y [m]."""
    columns, rows = (max(8, round(extent * DOTS_PER_METRE)) for extent in size)
    return rows, columns


def _marker_cell(rows: int, columns: int) -> int:
    return max(1, round(_MARKER_SHARE * min(rows, columns) / MARKER_CELLS))


def _circuit_board(rows: int, columns: int, rng: np.random.Generator) -> Artwork:
    mask = np.array(_MASKS[rng.integers(len(_MASKS))])
    art = np.full((rows, columns, 3), mask, dtype=np.uint8)
    for _ in range(round(rows * columns / 2200)):
        _trace(art, mask + _COPPER, rng)
    for _ in range(round(rows * columns / 2500)):
        row, column = rng.integers([rows - 6, columns - 6])
        _fill(art, row, column, 5, 5, _TIN)
    taken = np.zeros((rows, columns), dtype=bool)
    for _ in range(max(12, round(rows * columns / 2000))):
        _chip(art, taken, rng)
    for _ in range(max(2, round(rows * columns / 7000))):
        row, column = rng.integers([rows - 8, columns - 24])
        _words(art, row, column, 5, 24, _LETTERS, rng)
    return art


def _trace(art: Artwork, colour: NDArray[np.int_], rng: np.random.Generator) -> None:
    """Copper under the mask: along one axis, then along the other."""
    rows, columns = art.shape[:2]
    (row, end_row), (column, end_column) = (
        np.sort(rng.integers(n, size=2)).tolist() for n in (rows, columns)
    )
    _fill(art, row, column, 3, end_column - column, tuple(colour))
    _fill(art, row, end_column, end_row - row, 3, tuple(colour))


def _chip(art: Artwork, taken: NDArray[np.bool_], rng: np.random.Generator) -> None:
    """A black body with tin pins on two sides and a dot at pin 1, where no other chip is in the way."""
    rows, columns = art.shape[:2]
    height, width = rng.integers([10, 14], [max(11, rows // 4), max(15, columns // 3)]).tolist()
    row, column = rng.integers([4, 4], [max(5, rows - height - 4), max(5, columns - width - 4)]).tolist()
    place = (slice(row - 4, row + height + 4), slice(column - 4, column + width + 4))
    if taken[place].any():
        return
    taken[place] = True
    for pin in range(column, column + width - 2, 6):
        _fill(art, row - 4, pin, height + 8, 3, _TIN)
    _fill(art, row, column, height, width, _CHIP)
    _fill(art, row + 2, column + 2, 3, 3, _LETTERS)


def _label(rows: int, columns: int, rng: np.random.Generator) -> Artwork:
    art = np.full((rows, columns, 3), _PAPER, dtype=np.uint8)
    band = _LABELS[rng.integers(len(_LABELS))]
    height = round(rows * rng.uniform(0.2, 0.35))
    _fill(art, 0, 0, height, columns, band)
    _words(art, height // 4, columns // 12, height // 2, round(0.6 * columns), _PAPER, rng)
    _fill(art, height + rows // 10, round(0.8 * columns), rows // 4, columns // 8, band)
    for row in range(height + rows // 10, round(0.68 * rows), max(6, rows // 9)):
        width = round(columns * rng.uniform(0.3, 0.65))
        _words(art, row, columns // 12, max(3, rows // 18), width, _INK, rng)
    column = columns // 12
    while column < 0.9 * columns:  # the bar code
        bar, gap = rng.integers(2, 9, size=2)
        _fill(art, round(0.74 * rows), column, round(0.2 * rows), int(bar), _INK)
        column += int(bar + gap)
    return art


def _words(
    art: Artwork,
    row: int,
    column: int,
    height: int,
    width: int,
    colour: Sequence[int],
    rng: np.random.Generator,
) -> None:
    """Something that from afar looks like words."""
    end = column + width
    while column < end:
        letter = int(rng.integers(2, max(3, height)))
        _fill(art, row + int(rng.integers(0, 2)), column, height, letter, colour)
        column += letter + int(rng.integers(1, max(2, height)))


def _marker(rows: int, columns: int, number: int) -> Artwork:
    cell = _marker_cell(rows, columns)
    ink = marker_image(number, cell)
    art = np.full((rows, columns, 3), _PAPER, dtype=np.uint8)
    row, column = (rows - len(ink)) // 2, (columns - len(ink)) // 2
    art[row : row + len(ink), column : column + len(ink)] = np.where(ink[..., None] > 0, _PAPER, _INK)
    return art


def _fill(art: Artwork, row: int, column: int, height: int, width: int, colour: Sequence[int]) -> None:
    """A rectangle, as far as it lies on the face."""
    art[max(row, 0) : max(row + height, 0), max(column, 0) : max(column + width, 0)] = colour
