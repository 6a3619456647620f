"""The measurement of the shown pose's age: an age that is put in comes out."""

from typing import Any

import numpy as np
import pytest

from cobot_lfd.arrays import Array
from tests.studio_pose_age import ages


class Page:
    """A page that has drawn the handle in these rows."""

    def __init__(self, rows: Array) -> None:
        self._rows = rows

    def evaluate(self, _: str) -> Any:
        """What it noted."""
        return self._rows.tolist()


class Lowered:
    """A tool that rests, goes down and rests."""

    times = np.arange(0.0, 3.0, 1 / 30)
    heights = np.maximum(0.05, 0.2 - 0.15 * np.maximum(times - 1.0, 0.0))
    history = np.column_stack([times, heights])


def rows(age: float) -> Array:
    """When and in which row the handle is seen, drawn twenty times in a second from poses of an age [s]."""
    drawn = np.arange(0.3, 2.9, 0.05)
    shown = np.interp(drawn - age, Lowered.times, Lowered.heights)
    return np.column_stack([drawn, 240.0 - 300.0 * shown])


@pytest.mark.parametrize("age", [0.0, 0.06, 0.2])
def test_an_age_that_is_put_in_comes_out(age: float) -> None:
    measured = ages(Page(rows(age)), Lowered())  # type: ignore[arg-type]  # it has a history as well
    assert measured.median == pytest.approx(age, abs=1e-6)
    assert measured.n_pictures > 5


def test_too_few_pictures_tell_no_age() -> None:
    assert np.isnan(ages(Page(rows(0.1)[:4]), Lowered()).median)  # type: ignore[arg-type]  # as above
