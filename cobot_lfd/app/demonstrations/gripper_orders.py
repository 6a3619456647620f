"""What a gripper was told, worked out from what its encoder saw."""

import numpy as np

from cobot_lfd.arrays import Array

_MOVES = 0.001  # [m] by which the fingers must have moved for it to count as an order


def gripper_orders(openings: Array, maximum: float) -> Array:
    """Orders to fingers that close or open all the way, for recordings that did not keep the orders.

    Args:
        openings: Measured distance between the fingers [m], shape (M,).
        maximum: Opening of the open gripper [m].

    Returns:
        The ordered opening [m], 0 or ``maximum``, shape (M,).
    """
    orders, order = np.empty(len(openings)), maximum
    farthest = float(openings[0]) if len(openings) else 0.0
    if farthest < maximum - 2 * _MOVES:
        order = 0.0
    for i, opening in enumerate(openings):
        is_open = order > 0.0
        farthest = max(farthest, opening) if is_open else min(farthest, opening)
        if (farthest - opening if is_open else opening - farthest) > _MOVES:
            order, farthest = (0.0 if is_open else maximum), float(opening)
        orders[i] = order
    return orders


def guessed_orders(openings: Array) -> Array:
    """The same where the gripper is unknown: the widest opening that was seen counts as open."""
    return gripper_orders(openings, float(max(openings.max(initial=0.0), _MOVES)))
