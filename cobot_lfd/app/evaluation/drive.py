"""Driving an executor through trials: whatever happens to one of them costs that one only."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, field
from time import monotonic

from cobot_lfd.app.evaluation.perform import Performed, fallen, verdict_on
from cobot_lfd.app.evaluation.plan import Trial
from cobot_lfd.errors import CobotError
from cobot_lfd.outcome import Outcome, Verdict

Perform = Callable[[Trial], Performed]

_ATTEMPTS = 2  # an episode that failed to give a result is tried once more
_LOOK_EVERY = 1.0  # [s] between two looks for episodes that hang
_GRACE = 30.0  # [s] beyond its limit that an episode gets where the executor itself should have ended it


@dataclass(slots=True)
class _Running:
    """An episode that is under way."""

    trial: Trial
    attempt: int
    since: float = field(default_factory=monotonic)


def drive(
    executor: Executor,
    perform: Perform,
    trials: Iterable[Trial],
    *,
    at_once: int,
    time_limit: float,
) -> Iterator[Performed]:
    """The results of trials, each as soon as it is there, in whatever order they end.

    No trial ends the others: one whose process dies, that hangs, or that raises is tried once more and then
    recorded as what happened to it.

    Args:
        executor: Where trials run.
        perform: Runs one trial.
        trials: What to run; taken as places become free.
        at_once: How many trials are handed to the executor at a time.
        time_limit: For one trial [s]. An executor that does not end a trial itself is left to it, and the
            trial counts as hanging.
    """
    waiting = deque((trial, 1) for trial in trials)
    running: dict[Future[Performed], _Running] = {}
    try:
        while waiting or running:
            while waiting and len(running) < at_once:
                trial, attempt = waiting.popleft()
                running[_submit(executor, perform, trial)] = _Running(trial, attempt)
            done, _ = wait(running, timeout=_LOOK_EVERY, return_when=FIRST_COMPLETED)
            for future in done | _overdue(running, time_limit + _GRACE):
                one = running.pop(future)
                performed = _outcome(future, one.trial)
                if performed is not None:
                    yield performed
                elif one.attempt < _ATTEMPTS:
                    waiting.append((one.trial, one.attempt + 1))
                else:
                    yield fallen(one.trial, _verdict(future, time_limit))
    finally:
        for future in running:
            future.cancel()


def _submit(executor: Executor, perform: Perform, trial: Trial) -> Future[Performed]:
    """Hand over a trial; an executor that is broken altogether gives a future that says so."""
    try:
        return executor.submit(perform, trial)
    except RuntimeError as error:  # BrokenExecutor is one, too
        future: Future[Performed] = Future()
        future.set_exception(error)
        return future


def _overdue(running: dict[Future[Performed], _Running], limit: float) -> set[Future[Performed]]:
    """Trials that should long be over; they are given up."""
    now = monotonic()
    late = {future for future, one in running.items() if now - one.since > limit and not future.done()}
    for future in late:
        future.cancel()
    return late


def _outcome(future: Future[Performed], trial: Trial) -> Performed | None:
    """The result of a trial; None where it gave none and may be tried again."""
    if not future.done() or future.cancelled() or future.exception() is not None:
        error = None if not future.done() or future.cancelled() else future.exception()
        return fallen(trial, verdict_on(error)) if isinstance(error, CobotError) else None
    return future.result()


def _verdict(future: Future[Performed], time_limit: float) -> Verdict:
    """What is recorded of a trial that gave no result twice."""
    error = None if not future.done() or future.cancelled() else future.exception()
    if error is None or isinstance(error, TimeoutError):
        return Verdict(Outcome.TIMEOUT, f"the program took longer than {time_limit:g} s, twice")
    if _is_death(error):
        return Verdict(Outcome.CRASHED, "twice")
    return verdict_on(error)


def _is_death(error: BaseException) -> bool:
    """Whether the process died, told by the names that the executors' libraries give to it."""
    return type(error).__name__ in {"ProcessExpired", "BrokenProcessPool", "BrokenExecutor", "KilledWorker"}
