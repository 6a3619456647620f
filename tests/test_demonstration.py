"""Demonstrations are checked when made and do not change afterwards."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd import Demonstration, Frame, Pose, SpatialDemonstration

FRAMES = {"cube": Frame(np.zeros(2), 0.0)}
LINE = np.linspace([0.0, 0.0], [1.0, 2.0], 11)


def test_without_times_a_path_lasts_one_second() -> None:
    assert_allclose(Demonstration(LINE, FRAMES).times, np.linspace(0, 1, 11))


def test_changing_the_callers_array_changes_nothing() -> None:
    path = LINE.copy()
    demo = Demonstration(path, FRAMES)
    path[0] = 99
    assert_allclose(demo.path, LINE)


def test_the_arrays_are_read_only() -> None:
    with pytest.raises(ValueError, match="read-only"):
        Demonstration(LINE, FRAMES).path[0] = 1.0


def test_positions_that_are_not_finite_are_refused() -> None:
    with pytest.raises(ValueError, match="not finite"):
        Demonstration(np.full((5, 2), np.nan), FRAMES)


def test_one_position_is_refused() -> None:
    with pytest.raises(ValueError, match="path has 1 positions"):
        Demonstration(LINE[:1], FRAMES)


def test_a_demonstration_without_frames_is_refused() -> None:
    with pytest.raises(ValueError, match="frames is empty"):
        Demonstration(LINE, {})


def test_times_that_repeat_are_refused() -> None:
    with pytest.raises(ValueError, match="strictly increasing"):
        Demonstration(LINE[:3], FRAMES, times=[0.0, 1.0, 1.0])


def test_a_spatial_path_needs_three_coordinates() -> None:
    with pytest.raises(ValueError, match=r"path has shape \(11, 2\)"):
        SpatialDemonstration(LINE, {"cube": Pose.identity()})
