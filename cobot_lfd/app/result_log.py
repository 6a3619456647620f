"""A file of results: one line per episode, on the disk as soon as the episode ends."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import BinaryIO, Self

from cobot_lfd.app.disk import told
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.errors import DataError

_CHUNK = 4096
_GROUP, _GROUP_TIME = 8, 2.0  # results, or time [s], after which the disk is waited for


@dataclass(frozen=True, slots=True)
class ResultLog:
    """What a file of results holds.

    Attributes:
        results: The results, in the order in which they were written.
        notes: What a user should know about the file, a sentence each; empty if all is well.
    """

    results: tuple[EpisodeResult, ...]
    notes: tuple[str, ...]


def append_result(file: Path, result: EpisodeResult) -> None:
    """Append one result as a whole line, which is safe on the disk when this returns.

    A half-written line at the end, left by a crash, is cut off first.

    Raises:
        DataError: If the disk is full or the file cannot be written.
    """
    append_results(file, [result])


def append_results(file: Path, results: Iterable[EpisodeResult]) -> None:
    """Append several results and wait for the disk once; see ``append_result``."""
    lines = "".join(f"{result.to_json()}\n" for result in results).encode()
    with told(file, "append a result to"), file.open("ab+") as stream:
        stream.truncate(_end_of_whole_lines(stream))
        stream.write(lines)
        stream.flush()
        os.fsync(stream.fileno())


class ResultWriter:
    """Appends results one by one in a ``with`` statement; they are safe on the disk in small groups.

    A line has left this process when ``write`` returns, so that only a failure of the whole machine can lose
    the last few.
    """

    def __init__(self, file: Path) -> None:
        """Open the file; a half-written line at its end, left by a crash, is cut off.

        Raises:
            DataError: If the file cannot be written.
        """
        self._file = file
        with told(file, "append a result to"):
            self._stream = file.open("ab+")
            self._stream.truncate(_end_of_whole_lines(self._stream))
        self._unsynced, self._synced_at = 0, monotonic()

    def write(self, result: EpisodeResult) -> None:
        """Append one result as a whole line.

        Raises:
            DataError: If the disk is full.
        """
        with told(self._file, "append a result to"):
            self._stream.write(f"{result.to_json()}\n".encode())
            self._stream.flush()
            self._unsynced += 1
            if self._unsynced >= _GROUP or monotonic() - self._synced_at > _GROUP_TIME:
                self._sync()

    def __enter__(self) -> Self:
        """The writer itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Wait for the disk and close the file."""
        with told(self._file, "append a result to"), self._stream:
            self._sync()

    def _sync(self) -> None:
        os.fsync(self._stream.fileno())
        self._unsynced, self._synced_at = 0, monotonic()


def read_results(file: Path) -> ResultLog:
    """Read a file of results; a half-written last line is left out and told.

    Raises:
        DataError: If the file is missing, or a line before the last is no result.
    """
    with told(file, "read"):
        *lines, rest = file.read_bytes().split(b"\n")
    results = tuple(_read_line(file, number, line) for number, line in enumerate(lines, start=1))
    notes = (f"{file}: the last line is half written and left out; run its episode again.",) if rest else ()
    return ResultLog(results, notes)


def _read_line(file: Path, number: int, line: bytes) -> EpisodeResult:
    try:
        return EpisodeResult.from_json(line.decode(errors="replace"))
    except DataError as error:
        raise DataError(
            f"{file}, line {number}: {error} Remove the line and run its episode again."
        ) from error


def _end_of_whole_lines(stream: BinaryIO) -> int:
    """Number of bytes up to the last end of a line, looking from the end of the file."""
    end = stream.seek(0, os.SEEK_END)
    while end > 0:
        start = max(0, end - _CHUNK)
        stream.seek(start)
        newline = stream.read(end - start).rfind(b"\n")
        if newline >= 0:
            return start + newline + 1
        end = start
    return 0
