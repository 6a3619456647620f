"""Which candidates are frames of the task, each with the reason: by leaving one demonstration out in turn."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.frame import FrameKind
from cobot_lfd.learning.data import TaskDemonstration, collect
from cobot_lfd.learning.fitting import N_STEPS, identify, with_known_kinds
from cobot_lfd.learning.selection import Comparison, Selection, compare_frames
from cobot_lfd.learning.settings import IMPROVED


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """What is said of one candidate.

    Attributes:
        kept: Whether it is a frame of the task.
        comparison: How left-out demonstrations are predicted with it and without; None for an only frame.
        reason: Why, as a sentence.
    """

    kept: bool
    comparison: Comparison | None
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class FrameChoice:
    """What was chosen.

    Attributes:
        verdicts: What is said of each candidate.
        kinds: Each candidate's kind.
        errors: Mean distance of each demonstration from what the others predict with the kept [m], (N,).
    """

    verdicts: Mapping[str, Verdict]
    kinds: Mapping[str, FrameKind]
    errors: Array


def choose_frames(
    demonstrations: Sequence[TaskDemonstration], known_kinds: Mapping[str, FrameKind]
) -> FrameChoice:
    """Keep the fewest candidates that predict left-out demonstrations about as well as any set of them.

    Args:
        demonstrations: At least three, all with the same candidates as frames.
        known_kinds: Kinds that are not put to the test.
    """
    data = collect(demonstrations, N_STEPS)
    settings = replace(IMPROVED, kinds=dict(known_kinds))
    findings = with_known_kinds(identify(data, settings, np.random.default_rng(0)), settings)
    oriented = [finding.kind is FrameKind.ORIENTED for finding in findings]
    selection = compare_frames(data, oriented)
    verdicts = {name: _verdict(j, selection) for j, name in enumerate(data.names)}
    kinds = {finding.name: finding.kind for finding in findings}
    return FrameChoice(verdicts, kinds, selection.errors[selection.frames])


def _verdict(frame: int, selection: Selection) -> Verdict:
    kept = frame in selection.frames
    comparison = selection.compare(frame)
    if comparison is None:
        return Verdict(True, None, "it is the only frame that is needed.")
    with_it, without = 1e3 * comparison.with_it.mean(), 1e3 * comparison.without.mean()
    n = len(comparison.with_it)
    told = f"{without:.1f} mm without it, {with_it:.1f} mm with it"
    if kept:
        passed = "every demonstration passes it closely, and " if frame in selection.visited else ""
        reason = (
            f"{passed}it predicts left-out demonstrations better ({told}; in {comparison.n_helped} of {n})."
        )
    else:
        percent, error = 100 * np.expm1(comparison.gain), 100 * comparison.standard_error
        reason = (
            f"left-out demonstrations are predicted about as well without it ({told}; {percent:+.0f} ± "
            f"{error:.0f} %, in {comparison.n_helped} of {n})."
        )
    return Verdict(kept, comparison, reason)
