"""Keeps the simulation in step with the clock on the wall, and says when it cannot."""

from collections import deque
from time import perf_counter, sleep

_AHEAD = 0.004  # [s] by which the simulation may be ahead before it waits
_BEHIND = 0.1  # [s] by which it may be behind before the lost time is given up, so that it never rushes
_WINDOW = 1.0  # [s] over which the real-time factor is measured


class Clock:
    """Real time for a simulation.

    Attributes:
        simulated: Simulated time in all [s].
        lost: Time that was given up in all because the simulation was too slow for real time [s].
        pace: Simulated time per real time that is aimed at; 1 is real time.
    """

    def __init__(self, time_step: float) -> None:
        self.lost = 0.0
        self.pace = 1.0
        self._time_step = time_step
        self._simulated = 0.0
        self._start = perf_counter()
        self._marks: deque[tuple[float, float]] = deque()
        self.simulated = 0.0

    def restart(self) -> None:
        """Begin anew after something else took time."""
        self._simulated, self._start = 0.0, perf_counter()
        self._marks.clear()

    def step(self) -> None:
        """A time step was simulated; wait if that was faster than real time."""
        self._simulated += self._time_step / self.pace
        self.simulated += self._time_step
        ahead = self._simulated - (perf_counter() - self._start)
        if ahead > _AHEAD:
            sleep(ahead)
        elif ahead < -_BEHIND:
            if self.pace <= 1.0:
                self.lost -= ahead
            self._start -= ahead
        self._mark()

    @property
    def factor(self) -> float:
        """Simulated time per real time, over the last second."""
        if len(self._marks) < 2:
            return 1.0
        (wall, simulated), (wall_now, simulated_now) = self._marks[0], self._marks[-1]
        return (simulated_now - simulated) / max(wall_now - wall, 1e-9)

    def _mark(self) -> None:
        now = perf_counter()
        if not self._marks or now - self._marks[-1][0] > 0.05:
            self._marks.append((now, self.simulated))
            while now - self._marks[0][0] > _WINDOW:
                self._marks.popleft()
