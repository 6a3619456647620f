"""The measurement of the shown pose's age: an age that is put in comes out."""

import numpy as np
import pytest

from cobot_lfd.arrays import Array
from tests.studio_pose_age import ages

PERIOD = 1 / 30  # [s] between two poses


def history() -> Array:
    """A tool that rests, goes down and rests."""
    times = np.arange(90) * PERIOD
    heights = np.clip(0.2 - 0.15 * (times - 1.0), 0.05, 0.2)
    return np.column_stack([times, np.full((90, 2), 0.4), heights])


def pictures(age: float, every: int) -> Array:
    """Pictures of every so-manieth pose, given to the graphics at an age [s], and finished 20 ms later."""
    times, places = history()[::every, :1], history()[::every, 1:]
    return np.hstack([times + age, times + age + 0.02, places])


@pytest.mark.parametrize("age", [0.0, 0.06, 0.2])
@pytest.mark.parametrize("every", [1, 3])
def test_an_age_that_is_put_in_comes_out(age: float, every: int) -> None:
    measured = ages(pictures(age, every), history())
    assert measured.given == pytest.approx(age)
    assert measured.finished == pytest.approx(age + 0.02)
    assert measured.replaced == pytest.approx(age + 0.02 + every * PERIOD)
    assert len(measured.given) >= 30 // every - 1  # of one second on the way


def test_a_picture_that_is_drawn_twice_is_older_the_second_time() -> None:
    once = pictures(0.05, 1)
    again = once + np.array([0.01, 0.01, 0.0, 0.0, 0.0])
    twice = np.stack([once, again], axis=1).reshape(-1, 5)
    assert np.unique(ages(twice, history()).given.round(6)) == pytest.approx([0.05, 0.06])


def test_a_tool_at_rest_tells_no_age() -> None:
    measured = ages(pictures(0.1, 1)[:20], history())
    assert not len(measured.given)
    assert "unknown" in str(measured)
