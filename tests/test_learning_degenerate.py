"""Poor input gives a clear error or a right result."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd import Demonstration, Frame, TaskParameterisedGMM
from cobot_lfd.errors import DataError
from cobot_lfd.learning.experiments.synthetic import TASKS, SyntheticTask, demonstrations

LINE = np.linspace([0.0, 0.0], [1.0, 0.2], 60)
FRAMES = {"a": Frame(np.zeros(2), 0.0), "b": Frame(np.array([1.0, 0.2]), 1.0)}
METHODS = ("improved", "paper", "conventional")


def fit(demos: list[Demonstration], method: str) -> TaskParameterisedGMM:
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="component")
        return TaskParameterisedGMM.fit(demos, method=method)


@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize("method", METHODS)
def test_identical_demonstrations_are_repeated(method: str, n: int) -> None:
    path = fit([Demonstration(LINE, FRAMES)] * n, method).reproduce(FRAMES, 60)
    assert_allclose(path.mean, LINE, atol=0.01)


def test_paths_of_two_points_are_lines() -> None:
    path = fit([Demonstration(LINE[[0, -1]], FRAMES)] * 3, "improved").reproduce(FRAMES, 3)
    assert_allclose(path.mean, np.linspace([0.0, 0.0], [1.0, 0.2], 3), atol=0.01)


@pytest.mark.parametrize("method", METHODS[1:])
def test_paths_of_two_points_are_too_few_for_mixtures(method: str) -> None:
    with pytest.raises(ValueError, match="6 points are too few for 4 components"):
        fit([Demonstration(LINE[[0, -1]], FRAMES)] * 3, method)


@pytest.mark.parametrize("method", METHODS)
def test_a_frame_that_never_moves_is_no_harm(method: str) -> None:
    demos = []
    for i in range(5):
        end = np.array([1.0 + 0.1 * i, 0.3 * i])
        demos.append(
            Demonstration(np.linspace([0, 0], end, 60), {"a": FRAMES["a"], "b": Frame(end, 0.5 * i)})
        )
    new = {"a": FRAMES["a"], "b": Frame(np.array([1.15, 0.5]), 0.2)}
    path = fit(demos, method).reproduce(new)
    assert np.linalg.norm(path.mean[-1] - new["b"].position) < 0.1


@pytest.mark.parametrize("method", METHODS)
def test_demonstrations_that_do_not_move_are_refused(method: str) -> None:
    with pytest.raises(DataError, match="no demonstration moves"):
        fit([Demonstration(np.ones((30, 2)), FRAMES)] * 4, method)


def test_no_demonstrations_are_refused() -> None:
    with pytest.raises(ValueError, match="demonstrations is empty"):
        fit([], "improved")


def test_a_path_needs_two_steps() -> None:
    with pytest.raises(ValueError, match="n_steps is 1; it must be at least 2"):
        fit([Demonstration(LINE, FRAMES)] * 3, "improved").reproduce(FRAMES, 1)


def test_planar_and_spatial_demonstrations_do_not_mix() -> None:
    rng = np.random.default_rng(0)
    mixed = demonstrations(TASKS[1], 1, rng) + demonstrations(SyntheticTask(dimension=3), 1, rng)
    with pytest.raises(ValueError, match="planar and spatial demonstrations are mixed"):
        TaskParameterisedGMM.fit(mixed)
