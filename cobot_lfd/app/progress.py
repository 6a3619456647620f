"""Progress on standard error: a bar on a terminal, plain lines elsewhere."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


class Reporter(Protocol):
    """Takes a note after each item."""

    def __call__(self, note: str) -> None:
        """One more item is done; ``note`` says how it went."""
        ...


@contextmanager
def progress(what: str, n_items: int) -> Iterator[Reporter]:
    """Show how far a piece of work has come.

    Args:
        what: What is being done, such as "recording".
        n_items: How many items there are.
    """
    console = Console(stderr=True, highlight=False, markup=False)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(what, total=n_items)
        done = 0

        def report(note: str) -> None:
            nonlocal done
            done += 1
            bar.console.print(f"{what} {done}/{n_items}: {note}", soft_wrap=True)
            bar.advance(task)

        yield report
