"""The border to S. Calinon's demonstration files, whose task parameters need not be rotations.

A folder holds, per demonstration n, ``samplen_Data.txt`` with the rows t, x, y, and per frame j
``samplen_framej_A.txt`` with T blocks of 3 x 3 side by side (the first row and column belong to time) and
``samplen_framej_b.txt`` of shape (3, T).

There a point is seen from a frame as A^-1 (p - b) with any invertible A. Our frames are rotations. A constant
factor of A, or a constant reflection of a frame's own axes, only renames the local coordinates; the same
model comes out, so both are taken off here. Anything else is refused.
"""

from pathlib import Path

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame


def read_calinon(folder: Path) -> list[Demonstration]:
    """Read all demonstrations of a folder.

    Raises:
        DataError: If there are none, a file is malformed, a frame moves, or its A is no multiple of a
            rotation or reflection that is the same in all demonstrations.
    """
    numbers = sorted(int(p.name[6:-9]) for p in folder.glob("sample*_Data.txt"))
    if not numbers:
        raise DataError(f"{folder} holds no sample*_Data.txt.")
    n_frames = len(list(folder.glob(f"sample{numbers[0]}_frame*_A.txt")))
    signs: dict[int, tuple[float, float]] = {}
    return [_read_sample(folder, n, n_frames, signs) for n in numbers]


def _read_sample(
    folder: Path, number: int, n_frames: int, signs: dict[int, tuple[float, float]]
) -> Demonstration:
    """One demonstration; ``signs`` holds each frame's scale and handedness as first met."""
    rows = _numbers(folder / f"sample{number}_Data.txt")
    frames = {}
    for j in range(1, n_frames + 1):
        name = f"sample{number}_frame{j}"
        blocks = _numbers(folder / f"{name}_A.txt").reshape(3, -1, 3).transpose(1, 0, 2)[:, 1:, 1:]
        origins = _numbers(folder / f"{name}_b.txt")[1:]
        if np.ptp(blocks, axis=0).max() > 1e-9 or np.ptp(origins, axis=1).max() > 1e-9:
            raise DataError(f"{folder / name}: the frame moves; only frames at rest can be learnt from.")
        rotation, kind = _as_rotation(blocks[0], f"{folder / name}_A.txt")
        if not np.allclose(signs.setdefault(j, kind), kind, rtol=1e-4):
            raise DataError(f"{folder / name}_A.txt: scale or handedness differs between demonstrations.")
        frames[f"frame{j}"] = Frame(origins[:, 0], float(np.arctan2(rotation[1, 0], rotation[0, 0])))
    return Demonstration(rows[1:].T, frames, rows[0])


def _as_rotation(matrix: Array, where: str) -> tuple[Array, tuple[float, float]]:
    """The rotation in A, with the scale and the handedness that were taken off."""
    determinant = float(np.linalg.det(matrix))
    scale = float(np.sqrt(abs(determinant)))
    if scale < 1e-12 or not np.allclose(matrix.T @ matrix, scale**2 * np.eye(2), atol=1e-3 * scale**2):
        raise DataError(
            f"{where}: A is no multiple of a rotation or reflection; such frames are not supported."
        )
    sign = float(np.sign(determinant))
    return matrix / scale @ np.diag([1.0, sign]), (scale, sign)


def _numbers(path: Path) -> Array:
    """A comma-separated table."""
    try:
        return np.loadtxt(path, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        raise DataError(f"{path} cannot be read as a table of numbers: {error}.") from error
