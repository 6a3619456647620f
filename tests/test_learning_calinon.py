"""Reading the standard example's files, with their scaled and reflected frames."""

import os
import warnings
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd import TaskParameterisedGMM
from cobot_lfd.arrays import Array
from cobot_lfd.errors import DataError
from cobot_lfd.learning.experiments.calinon import read_calinon

T = 30


def write(folder: Path, number: int, matrices: list[Array], origins: list[Array], path: Array) -> None:
    times = np.linspace(0.01, 2, T)
    np.savetxt(folder / f"sample{number}_Data.txt", np.vstack([times, path.T]), delimiter=",")
    for j, (matrix, origin) in enumerate(zip(matrices, origins, strict=True), start=1):
        block = np.eye(3)
        block[1:, 1:] = matrix
        np.savetxt(folder / f"sample{number}_frame{j}_A.txt", np.tile(block, T), delimiter=",")
        b = np.tile(np.append(0.0, origin)[:, None], T)
        np.savetxt(folder / f"sample{number}_frame{j}_b.txt", b, delimiter=",")


def turn(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def test_scale_and_reflection_are_taken_off(tmp_path: Path) -> None:
    path = np.linspace([0.0, 0.0], [1.0, 1.0], T)
    for number, angle in ((1, 0.3), (2, -1.0)):
        reflected = 0.3162 * turn(angle) @ np.diag([1.0, -1.0])
        write(tmp_path, number, [turn(angle), reflected], [np.zeros(2), np.ones(2)], path)
    demos = read_calinon(tmp_path)
    assert [round(d.frames["frame2"].angle, 6) for d in demos] == [0.3, -1.0]
    assert_allclose(demos[0].frames["frame2"].position, [1, 1])
    assert_allclose(demos[1].path, path)


def test_a_shear_is_refused(tmp_path: Path) -> None:
    shear = np.array([[1.0, 0.5], [0.0, 1.0]])
    write(tmp_path, 1, [shear], [np.zeros(2)], np.zeros((T, 2)))
    with pytest.raises(DataError, match="no multiple of a rotation or reflection"):
        read_calinon(tmp_path)


def test_handedness_that_changes_is_refused(tmp_path: Path) -> None:
    for number, sign in ((1, 1.0), (2, -1.0)):
        write(tmp_path, number, [np.diag([1.0, sign])], [np.zeros(2)], np.zeros((T, 2)))
    with pytest.raises(DataError, match="handedness differs between demonstrations"):
        read_calinon(tmp_path)


def test_an_empty_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"holds no sample\*_Data.txt"):
        read_calinon(tmp_path)


@pytest.mark.skipif("CALINON_DATA" not in os.environ, reason="set CALINON_DATA to the folder of the data")
def test_the_public_example_is_learnt() -> None:
    """Each of the four demonstrations is repeated in its own scene, ends within 5 % of the way."""
    demos = read_calinon(Path(os.environ["CALINON_DATA"]))
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="component")
        model = TaskParameterisedGMM.fit(demos)
    for demo in demos:
        path = model.reproduce(demo.frames, len(demo.path))
        size = np.linalg.norm(demo.path[-1] - demo.path[0])
        assert np.linalg.norm(path.mean[[0, -1]] - demo.path[[0, -1]], axis=1).max() < 0.05 * size
