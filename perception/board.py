"""A ChArUco board, a chessboard with markers in its white squares, and where it is seen in a picture."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.arrays import Array, frozen_array
from perception.picture import Picture

_DICTIONARY = cv2.aruco.DICT_4X4_50
_FEWEST_CORNERS = 6  # Fewer tell too little to be worth taking a view into account.
_WINDOW = (2, 5)  # Half the side of the squares in which corners are placed exactly, least and most [px].
_STOP = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 50, 1e-3)


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
    def margin(self) -> float:
        """White between a marker and the corners of its square, along either side [m]."""
        return 0.5 * (self.square - self.marker)

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
    grey = np.asarray(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY), np.uint8)
    pixels, numbers, _, _ = detector.detectBoard(grey)
    if numbers is None or len(numbers) < _FEWEST_CORNERS:
        return None
    corners = np.asarray(charuco.getChessboardCorners(), dtype=np.float64)
    points = corners[np.ravel(numbers)]
    centred = np.array([[1.0, -1.0, 0.0]]) * (points - np.array([board.width / 2, board.height / 2, 0.0]))
    rough = np.asarray(pixels, dtype=np.float64).reshape(-1, 2)
    return BoardView(centred, _refined(grey, centred, rough, board.margin))


def _refined(grey: NDArray[np.uint8], points: Array, pixels: Array, margin: float) -> Array:
    """Corners placed by their nearest surroundings: markers, which OpenCV lets in, draw them aside."""
    spread = np.linalg.lstsq(_centred(points[:, :2]), _centred(pixels), rcond=None)[0]
    pixels_per_metre = float(np.linalg.svd(spread, compute_uv=False)[-1])
    half = int(np.clip(margin * pixels_per_metre, *_WINDOW))
    start = pixels.astype(np.float32).reshape(-1, 1, 2)
    placed = cv2.cornerSubPix(grey, start, (half, half), (-1, -1), _STOP)
    return np.asarray(placed, dtype=np.float64).reshape(-1, 2)


def _centred(values: Array) -> Array:
    return np.asarray(values - values.mean(axis=0))


def _charuco(board: Board) -> cv2.aruco.CharucoBoard:
    dictionary = cv2.aruco.getPredefinedDictionary(_DICTIONARY)
    return cv2.aruco.CharucoBoard((board.columns, board.rows), board.square, board.marker, dictionary)
