"""Orders from other threads, and how a waiting one ends what is going on."""

from collections.abc import Callable
from queue import SimpleQueue

from cobot_lfd.app.execute import Observer
from cobot_lfd.app.recording.hand import Hand, HandAction
from robots import ArmState


class Cancelled(Exception):  # noqa: N818 -- no error: the person asked for something else
    """Ends a replay or a trial early."""


class Inbox:
    """What has been ordered and is not done yet.

    Attributes:
        is_open: Whether more will be done.
    """

    def __init__(self) -> None:
        self.is_open = True
        self._orders: SimpleQueue[Callable[[], None]] = SimpleQueue()

    @property
    def waits(self) -> bool:
        """Whether an order waits."""
        return not self._orders.empty()

    def put(self, order: Callable[[], None]) -> None:
        """Order something, from any thread."""
        self._orders.put(order)

    def take(self) -> Callable[[], None]:
        """The next order."""
        return self._orders.get()

    def close(self) -> None:
        """Nothing more will be done; what is going on ends."""
        self.is_open = False
        self.put(lambda: None)

    def interrupting(self, observer: Observer) -> Observer:
        """The same observer, which ends what it observes, by ``Cancelled``, as soon as an order waits."""

        def observe() -> None:
            observer()
            if self.waits or not self.is_open:
                raise Cancelled

        return observe

    def until_ordered(self, hand: Hand) -> Hand:
        """The same hand, which is done as soon as an order waits."""
        return _UntilOrdered(hand, self)


class _UntilOrdered:
    def __init__(self, hand: Hand, inbox: Inbox) -> None:
        self._hand, self._inbox = hand, inbox

    def act(self, state: ArmState) -> HandAction | None:
        """What the hand does; None as soon as there is something else to do."""
        return None if self._inbox.waits else self._hand.act(state)
