"""Results that outlive the process: one line per result, so that a long run can be stopped and resumed."""

import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

import cobot_lfd.learning
from cobot_lfd.errors import DataError

Values = Mapping[str, float]
"""The figures of one result by name."""


def code_fingerprint() -> str:
    """A hash of the learning code, of which results are true."""
    folder = Path(cobot_lfd.learning.__file__).parent
    text = b"".join(path.read_bytes() for path in sorted(folder.rglob("*.py")))
    return hashlib.sha256(text).hexdigest()[:16]


@dataclass(frozen=True, slots=True)
class Unit:
    """A piece of work whose result is kept.

    Attributes:
        key: What it is.
        number: Which training set.
        work: Makes the figures.
    """

    key: str
    number: int
    work: Callable[[], Values]


class Ledger:
    """A file of results; what stands in it is not worked out again.

    Args:
        path: The file, made if it is not there.
        provenance: What the results depend on, such as the code and the seed.

    Raises:
        DataError: If the file holds results of another provenance.
    """

    def __init__(self, path: Path, provenance: Mapping[str, str | int]) -> None:
        """Read what is there."""
        self._results: dict[str, dict[int, Values]] = {}
        path.parent.mkdir(parents=True, exist_ok=True)
        lines = path.read_bytes().splitlines(keepends=True) if path.is_file() else []
        whole = [line for line in lines if line.endswith(b"\n")]  # The last one may have been cut short.
        if whole and json.loads(whole[0]) != provenance:
            raise DataError(
                f"{path} holds results of {json.loads(whole[0])}, this run is {dict(provenance)}; "
                "name another file, or delete this one."
            )
        for line in whole[1:]:
            entry = json.loads(line)
            self._results.setdefault(entry["key"], {})[entry["number"]] = entry["values"]
        self._file = path.open("wb")
        self._file.write(b"".join(whole) or _line(dict(provenance)))
        self._file.flush()

    def __enter__(self) -> Self:
        """Itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the file."""
        self._file.close()

    def known(self, unit: Unit) -> bool:
        """Whether the result is there."""
        return unit.number in self._results.get(unit.key, {})

    def do(self, unit: Unit) -> None:
        """Work one result out, unless it is known, and write it down."""
        if self.known(unit):
            return
        values = unit.work()
        self._results.setdefault(unit.key, {})[unit.number] = values
        self._file.write(_line({"key": unit.key, "number": unit.number, "values": dict(values)}))
        self._file.flush()
        os.fsync(self._file.fileno())

    def results(self, key: str) -> Sequence[Values]:
        """What is known so far, in the order of the training sets."""
        return [values for _, values in sorted(self._results.get(key, {}).items())]


def _line(content: Mapping[str, object]) -> bytes:
    """One line of the file."""
    return (json.dumps(content) + "\n").encode()
