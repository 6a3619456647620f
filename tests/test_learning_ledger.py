"""Results that outlive the process."""

from pathlib import Path

import pytest

from cobot_lfd.errors import DataError
from cobot_lfd.learning.experiments.ledger import Ledger, Unit, Values

PROVENANCE: dict[str, str | int] = {"code": "abc", "seed": 7}


class Counter:
    """Work that counts how often it is done."""

    def __init__(self) -> None:
        """Not yet."""
        self.done = 0

    def __call__(self) -> Values:
        """Once more."""
        self.done += 1
        return {"figure": 0.1 + 0.2, "missing": float("nan")}


def test_what_is_known_is_not_worked_out_again(tmp_path: Path) -> None:
    work = Counter()
    for _ in range(2):
        with Ledger(tmp_path / "results.jsonl", PROVENANCE) as ledger:
            ledger.do(Unit("case", 3, work))
            assert ledger.results("case")[0]["figure"] == 0.1 + 0.2
    assert work.done == 1


def test_a_line_cut_short_is_worked_out_again_and_the_rest_kept(tmp_path: Path) -> None:
    path, work = tmp_path / "results.jsonl", Counter()
    with Ledger(path, PROVENANCE) as ledger:
        for number in (1, 0):
            ledger.do(Unit("case", number, work))
    path.write_bytes(path.read_bytes()[:-9])
    with Ledger(path, PROVENANCE) as ledger:
        assert ledger.known(Unit("case", 1, work))
        assert not ledger.known(Unit("case", 0, work))
        ledger.do(Unit("case", 0, work))
        assert len(ledger.results("case")) == 2
    assert work.done == 3


def test_results_of_other_code_are_refused(tmp_path: Path) -> None:
    with Ledger(tmp_path / "results.jsonl", PROVENANCE):
        pass
    with pytest.raises(
        DataError, match=r"this run is \{'code': 'xyz'.*name another file, or delete this one"
    ):
        Ledger(tmp_path / "results.jsonl", {**PROVENANCE, "code": "xyz"})
