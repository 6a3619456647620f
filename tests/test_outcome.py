"""Outcomes and verdicts: what is counted, and what is read."""

import pytest

from cobot_lfd.outcome import Outcome, Verdict


def test_only_success_succeeds() -> None:
    assert [outcome for outcome in Outcome if Verdict(outcome).succeeded] == [Outcome.SUCCESS]


@pytest.mark.parametrize("outcome", Outcome)
def test_kind_names_its_outcome(outcome: Outcome) -> None:
    assert Outcome.from_kind(outcome.kind) is outcome


def test_unknown_kind_names_the_choices() -> None:
    with pytest.raises(
        ValueError, match=r"no outcome is called 'won'; choose one of: success, object_not_seen"
    ):
        Outcome.from_kind("won")


def test_detail_is_appended_to_the_sentence() -> None:
    verdict = Verdict(Outcome.TIMEOUT, "30 s")
    assert verdict.sentence == "the time for the episode is over: 30 s"


def test_sentence_without_detail_is_the_outcomes() -> None:
    assert Verdict(Outcome.SUCCESS).sentence == "the task is done"
