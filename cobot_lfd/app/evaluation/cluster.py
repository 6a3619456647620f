"""An existing dask.distributed cluster as an executor."""

import faulthandler
import threading
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from cobot_lfd.app.evaluation.perform import Performed, perform
from cobot_lfd.app.evaluation.plan import Trial
from cobot_lfd.errors import CobotError

_CONNECTING = 10.0  # [s] that the scheduler is waited for
_GRACE = 10.0  # [s] beyond its limit after which a hanging worker ends itself
_ONE_AT_A_TIME = (
    threading.Lock()
)  # a worker may have several threads; the simulator wants a process of its own


@dataclass(frozen=True, slots=True)
class Cluster:
    """A cluster that can be used.

    Attributes:
        executor: Where tasks run.
        n_workers: How many tasks run at once.
    """

    executor: Executor
    n_workers: int


@contextmanager
def cluster_at(address: str) -> Iterator[Cluster]:
    """Use a cluster inside the block.

    Args:
        address: Of its scheduler, such as tcp://host:8786.

    Raises:
        CobotError: If dask.distributed is missing, or there is no scheduler, or it has no workers.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise CobotError(
            "--scheduler needs dask.distributed; install it with: pip install 'cobot-lfd[cluster]'"
        ) from error
    try:
        connect: Any = Client
        client = connect(address, timeout=_CONNECTING, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise CobotError(f"no dask scheduler answers at {address}: {error}") from error
    with client:
        n_workers = len(client.nthreads())
        if not n_workers:
            raise CobotError(f"the scheduler at {address} has no workers; start some: dask worker {address}")
        yield Cluster(client.get_executor(pure=False), n_workers)


@dataclass(frozen=True, slots=True)
class PerformWithin:
    """Performs a trial in a worker that ends itself if it hangs, whatever it hangs in.

    A cluster cannot end a task; its nanny starts another worker in place of one that has ended.

    Attributes:
        time_limit: For one trial [s].
        film_failures: Whether a failed episode is run again for a video of it.
    """

    time_limit: float
    film_failures: bool

    def __call__(self, trial: Trial) -> Performed:
        """Perform a trial."""
        with _ONE_AT_A_TIME:
            faulthandler.dump_traceback_later(self.time_limit + _GRACE, exit=True)
            try:
                return perform(trial, film_failures=self.film_failures)
            finally:
                faulthandler.cancel_dump_traceback_later()
