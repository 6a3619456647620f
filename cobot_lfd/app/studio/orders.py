"""What a person can order by a key, wherever it is pressed: on the page or in the window."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cobot_lfd.app.studio.session import Session

_TURN = np.deg2rad(10.0)


@dataclass(frozen=True, slots=True)
class Order:
    """One order.

    Attributes:
        label: What it is called.
        key: The key, a capital letter.
        do: Carries it out, in the session's thread.
    """

    label: str
    key: str
    do: Callable[[], None]

    @property
    def shown(self) -> str:
        """Label and key."""
        return f"{self.label} [{self.key}]"


@dataclass(frozen=True, slots=True)
class Orders:
    """All orders that have a key."""

    start: Order
    stop: Order
    next_scene: Order
    undo: Order
    gripper: Order
    lower: Order
    lift: Order
    left: Order
    right: Order
    align: Order
    guide: Order
    learn: Order
    attempt: Order
    halt: Order

    @classmethod
    def of(cls, session: Session) -> "Orders":
        """The orders to a session; those to the hand go to whichever hand it has when they are given."""
        stage = session.stage
        return cls(
            start=Order("Start", "R", session.start),
            stop=Order("Stop", "T", session.stop),
            next_scene=Order("Keep, next scene", "N", session.next_scene),
            undo=Order("Undo", "Z", session.undo),
            gripper=Order("Close or open the gripper", "G", lambda: stage.hand.close_or_open()),
            lower=Order("Lower", "S", lambda: stage.hand.lower()),
            lift=Order("Lift", "W", lambda: stage.hand.lift()),
            left=Order("Left", "Q", lambda: stage.hand.turn(_TURN)),
            right=Order("Right", "E", lambda: stage.hand.turn(-_TURN)),
            align=Order("To the part", "A", stage.align),
            guide=Order("Planar guide", "P", lambda: stage.hand.switch_guide()),
            learn=Order("Learn", "L", session.learn),
            attempt=Order("Let the arm try", "Y", session.try_it),
            halt=Order("Stop the arm", "X", lambda: None),
        )
