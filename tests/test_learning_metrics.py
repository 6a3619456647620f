"""The measures on paths whose values are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.frame import FrameKind
from cobot_lfd.learning import metrics

ORIENTED, LESS = FrameKind.ORIENTED, FrameKind.ORIENTATION_LESS
LINE = np.linspace([0.0, 0.0], [3.0, 4.0], 50)[None]


def test_f1_of_a_right_answer_is_one() -> None:
    assert metrics.identifier_f1({"a": ORIENTED, "b": LESS}, {"a": ORIENTED, "b": LESS}).score == 1.0


def test_f1_with_one_oriented_frame_missed_is_two_thirds() -> None:
    """The paper's 0.67: precision 1/2, recall 1."""
    result = metrics.identifier_f1({"a": LESS, "b": LESS}, {"a": ORIENTED, "b": LESS})
    assert (result.precision, result.recall) == (0.5, 1.0)
    assert result.score == pytest.approx(2 / 3)


def test_f1_is_undefined_where_no_frame_is_called_orientation_less() -> None:
    assert np.isnan(metrics.identifier_f1({"a": ORIENTED, "b": ORIENTED}, {"a": ORIENTED, "b": LESS}).score)


def test_f1_of_a_swapped_answer_is_zero() -> None:
    assert metrics.identifier_f1({"a": LESS, "b": ORIENTED}, {"a": ORIENTED, "b": LESS}).score == 0.0


def test_a_straight_line_is_efficient_and_has_no_edge() -> None:
    assert metrics.path_length(LINE) == pytest.approx(5.0)
    assert metrics.efficiency(LINE) == pytest.approx(1.0)
    assert metrics.detour(LINE) == pytest.approx(1.0)
    assert metrics.smoothness(LINE) == 0
    assert metrics.turns(LINE) == 0


def test_a_half_circle_is_longer_by_half_pi() -> None:
    angle = np.linspace(0, np.pi, 2000)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)[None]
    assert metrics.detour(circle) == pytest.approx(np.pi / 2, rel=1e-5)
    assert metrics.efficiency(circle) == pytest.approx(2 / np.pi, rel=1e-5)


def test_only_rising_slopes_count_as_sharp_edges() -> None:
    """A corner from slope 0 up to slope 2 counts where the rise is above 0.5; one downwards never."""
    x = np.arange(12.0)
    up = np.stack([x, np.where(x > 5, 2 * (x - 5), 0.0)], axis=1)[None]
    down = up * [1, -1]
    slope = (up[0, 2:, 1] - up[0, :-2, 1]) / 2
    expected = ((slope[2:] - slope[:-2]) / 2 > 0.5).sum()
    assert expected > 0
    assert metrics.sharp_edges(up)[0] == expected
    assert metrics.sharp_edges(down)[0] == 0


def test_turns_do_not_depend_on_the_axes() -> None:
    rng = np.random.default_rng(0)
    walk = np.cumsum(rng.normal(size=(4, 30, 2)), axis=1)
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    assert metrics.turns(walk) == metrics.turns(walk @ turn)


def test_each_end_reached_counts_half() -> None:
    starts, ends = LINE[:, 0], LINE[:, -1]
    assert metrics.reachability(LINE, starts, ends) == 100
    assert metrics.reachability(LINE, starts + 0.06, ends) == 50
    assert metrics.reachability(LINE, starts + 0.06, ends + 0.06) == 0


def test_distances_are_taken_over_all_times_and_at_the_ends() -> None:
    shifted = LINE + np.linspace(0, 1, 50)[:, None] * [0.0, 0.2]
    result = metrics.distances(shifted, LINE)
    assert_allclose([result.total, result.start, result.end], [0.1, 0.0, 0.2], atol=1e-12)


def test_a_minimum_jerk_line_has_a_log_jerk_of_ln_720() -> None:
    t = np.linspace(0, 1, 4001)
    path = (10 * t**3 - 15 * t**4 + 6 * t**5)[None, :, None] * np.array([3.0, 4.0])
    assert metrics.log_dimensionless_jerk(path) == pytest.approx(np.log(720), abs=1e-2)
