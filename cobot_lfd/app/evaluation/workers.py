"""Processes on this machine, as an executor: one that dies or hangs takes only its own task with it."""

import faulthandler
import os
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from multiprocessing import get_context
from typing import Any, ParamSpec, TypeVar

from pebble import ProcessPool

_P = ParamSpec("_P")
_T = TypeVar("_T")

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_LOOK_EVERY = 1.0  # [s] between two looks whether the coordinator still lives


class WorkerProcesses(Executor):
    """Runs tasks in processes that share nothing with this one.

    Unlike ``ProcessPoolExecutor``, which is broken for good when one of its processes dies, it starts another
    one, and it ends a task that takes too long. Processes end by themselves when this one is gone.
    """

    def __init__(self, n_workers: int, *, time_limit: float) -> None:
        """Make ready; processes start with the first task.

        Their linear algebra runs in one thread each, unless the environment says otherwise: more would take
        the cores from one another, for matrices that are too small to share.

        Args:
            n_workers: Number of processes.
            time_limit: For one task, after which its process is killed [s].
        """
        for name in _THREADS:
            os.environ.setdefault(name, "1")  # inherited; this process has loaded its libraries already
        self._pool: Any = ProcessPool(
            max_workers=n_workers,
            context=get_context("spawn"),
            initializer=_begin,
            initargs=(os.getpid(),),
        )
        self._time_limit = time_limit

    def submit(self, fn: Callable[_P, _T], /, *args: _P.args, **kwargs: _P.kwargs) -> Future[_T]:
        """Run a function in one of the processes.

        Its future raises ``TimeoutError`` if it took too long, ``pebble.ProcessExpired`` if its process died.
        """
        future: Future[_T] = self._pool.schedule(fn, args=args, kwargs=kwargs, timeout=self._time_limit)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes; what is under way is finished first, unless it is to be cancelled."""
        if cancel_futures:
            self._pool.stop()
        else:
            self._pool.close()
        if wait:
            self._pool.join()

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        """End the processes; at once if the block ended with an error, such as an interruption."""
        self.shutdown(cancel_futures=kind is not None)


def _begin(coordinator: int) -> None:
    """In a new process: leave Ctrl-C to the coordinator, end when it is gone, tell where a crash was."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    faulthandler.enable()
    threading.Thread(target=_end_with, args=(coordinator,), daemon=True).start()


def _end_with(coordinator: int) -> None:
    while os.getppid() == coordinator:
        time.sleep(_LOOK_EVERY)
    os._exit(1)
