"""What a recorded episode is, and the demonstration inside it."""

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from cobot_lfd.errors import DataError
from tests.app_examples import episode


def test_demonstration_is_the_planar_part_of_the_carry() -> None:
    recorded = episode()
    demonstration = recorded.demonstration()
    assert_array_equal(demonstration.path, recorded.tool_positions[10:40, :2])
    assert_array_equal(demonstration.times, recorded.times[10:40])


def test_demonstration_has_the_frames_that_were_seen() -> None:
    recorded = episode()
    assert dict(recorded.demonstration().frames) == {d.name: d.frame for d in recorded.detections}


def test_an_episode_without_a_carry_is_no_demonstration() -> None:
    recorded = replace(episode(), carrying=np.zeros(50, dtype=np.bool_))
    with pytest.raises(DataError, match="seed 3 has 0 samples of a carry; a demonstration needs at least 2"):
        recorded.demonstration()


def test_an_episode_without_detections_is_no_demonstration() -> None:
    with pytest.raises(DataError, match="no detected object, so its path has no frame"):
        replace(episode(), detections=()).demonstration()


def test_arrays_are_copied_and_read_only() -> None:
    recorded = episode()
    arrays = [getattr(recorded, field.name) for field in fields(recorded)]
    writable = [array for array in arrays if isinstance(array, np.ndarray) and array.flags.writeable]
    assert not writable


def test_series_of_different_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match=r"hand_forces has shape \(49, 3\); it must have shape \(50, 3\)"):
        replace(episode(), hand_forces=np.zeros((49, 3)))


def test_repeated_times_are_refused() -> None:
    with pytest.raises(ValueError, match="times must be strictly increasing"):
        replace(episode(), times=np.zeros(50))


def test_a_picture_of_floats_is_refused() -> None:
    floats: Any = np.zeros((4, 4, 3))
    with pytest.raises(ValueError, match=r"picture has shape \(4, 4, 3\) and type float64; it must be"):
        replace(episode(), picture=floats)


def test_flags_that_are_not_bool_are_refused() -> None:
    floats: Any = np.zeros(50)
    with pytest.raises(
        ValueError, match=r"carrying has shape \(50,\) and type float64; it must be \(50,\) of bool"
    ):
        replace(episode(), carrying=floats)


def test_a_negative_seed_is_refused() -> None:
    with pytest.raises(ValueError, match="seed is -1; it must be at least 0"):
        replace(episode(), seed=-1)
