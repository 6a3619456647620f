"""Orders to a gripper, worked out from its encoder."""

import numpy as np
from numpy.testing import assert_array_equal

from cobot_lfd.app.demonstrations.gripper_orders import gripper_orders, guessed_orders


def test_an_order_to_the_gripper_is_read_from_its_encoder() -> None:
    openings = np.concatenate(
        [np.full(5, 0.08), np.linspace(0.08, 0.04, 10), np.full(9, 0.04), np.linspace(0.04, 0.08, 10)]
    )
    orders = gripper_orders(openings, 0.08)
    assert_array_equal(orders[[0, 5, 8, 20, 23, 30]], [0.08, 0.08, 0.0, 0.0, 0.0, 0.08])
    assert_array_equal(np.unique(orders), [0.0, 0.08])


def test_a_gripper_that_starts_closed_is_told_so() -> None:
    assert_array_equal(gripper_orders(np.full(3, 0.04), 0.08), 0.0)


def test_the_widest_opening_that_was_seen_counts_as_open() -> None:
    assert_array_equal(guessed_orders(np.array([0.05, 0.05, 0.03, 0.01])), [0.05, 0.05, 0.0, 0.0])
