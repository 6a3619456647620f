"""A ChArUco board, a chessboard with markers in its white squares, and where it is seen in a picture."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array, frozen_array
from perception.picture import Picture

_DICTIONARY = cv2.aruco.DICT_4X4_50
_FEWEST_CORNERS = 6  # Fewer tell too little to be worth taking a view into account.


@dataclass(frozen=True, slots=True)
class Board:
    """A ChArUco board; its frame has the origin in its middle, x to the right, y to the top, z to the viewer.

    Attributes:
        columns: Number of squares from left to right.
        rows: Number of squares from top to bottom.
        square: Length of a square's sides [m].
        marker: Length of a marker's sides [m].
    """

    columns: int = 8
    rows: int = 6
    square: float = 0.03
    marker: float = 0.022

    @property
    def width(self) -> float:
        """Extent from left to right [m]."""
        return self.columns * self.square

    @property
    def height(self) -> float:
        """Extent from top to bottom [m]."""
        return self.rows * self.square

    def image(self, pixels_per_square: int = 40) -> NDArray[np.uint8]:
        """The board as it is printed, 0 or 255, without a margin, shape (rows, columns)."""
        size = (self.columns * pixels_per_square, self.rows * pixels_per_square)
        return np.asarray(_charuco(self).generateImage(size, marginSize=0, borderBits=1), dtype=np.uint8)


@dataclass(frozen=True, slots=True, eq=False)
class BoardView:
    """Corners of a board that are seen in a picture.

    Attributes:
        points: The corners in the board's frame [m], shape (n, 3).
        pixels: Where they are in the picture [px], shape (n, 2).
    """

    points: Array
    pixels: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "points", frozen_array(self.points, "points", (None, 3)))
        object.__setattr__(self, "pixels", frozen_array(self.pixels, "pixels", (len(self.points), 2)))


def find_board(picture: Picture, board: Board) -> BoardView | None:
    """The board's corners in a picture; None if fewer than six are seen.

    Args:
        picture: Red, green, blue, shape (height, width, 3).
        board: The board.
    """
    charuco = _charuco(board)
    detector = cv2.aruco.CharucoDetector(charuco)
    pixels, numbers, _, _ = detector.detectBoard(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY))
    if numbers is None or len(numbers) < _FEWEST_CORNERS:
        return None
    corners = np.asarray(charuco.getChessboardCorners(), dtype=np.float64)
    points = corners[np.ravel(numbers)]
    centred = np.array([[1.0, -1.0, 0.0]]) * (points - np.array([board.width / 2, board.height / 2, 0.0]))
    return BoardView(centred, np.asarray(pixels, dtype=np.float64).reshape(-1, 2))


def _charuco(board: Board) -> cv2.aruco.CharucoBoard:
    dictionary = cv2.aruco.getPredefinedDictionary(_DICTIONARY)
    return cv2.aruco.CharucoBoard((board.columns, board.rows), board.square, board.marker, dictionary)
