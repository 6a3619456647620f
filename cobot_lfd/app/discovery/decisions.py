"""What became of each candidate frame, with the reason."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from cobot_lfd.app.discovery.candidates import BASE, Candidates
from cobot_lfd.frame import Frame
from cobot_lfd.learning.frame_choice import FrameChoice


class Fate(Enum):
    """What became of a candidate."""

    KEPT = "kept"
    MERGED = "merged"
    DROPPED = "dropped"


@dataclass(frozen=True, slots=True)
class Decision:
    """What became of a candidate, and why.

    Attributes:
        name: The candidate.
        fate: What became of it.
        reason: Why, as a sentence.
    """

    name: str
    fate: Fate
    reason: str


def decide(
    candidates: Candidates, frames: Mapping[str, list[Frame] | str], choice: FrameChoice
) -> tuple[Decision, ...]:
    """What became of each candidate.

    Args:
        candidates: What could be a frame.
        frames: For the first of each group that moves as one its frame in each demonstration, or why there is
            none.
        choice: How left-out demonstrations were predicted.
    """
    decisions = []
    for motion in candidates.motions:
        first = motion.members[0]
        found = frames[first]
        if isinstance(found, str):
            decisions.append(Decision(first, Fate.DROPPED, found))
        else:
            verdict = choice.verdicts[first]
            decisions.append(Decision(first, Fate.KEPT if verdict.kept else Fate.DROPPED, verdict.reason))
        for name, test in zip(motion.members[1:], motion.tests, strict=True):
            what = "it never moves" if first == BASE else f"it moves rigidly with '{first}'"
            decisions.append(
                Decision(
                    name,
                    Fate.MERGED,
                    f"{what} (squared deviations {test.statistic:.1f}, up to {test.limit:.1f} are chance), "
                    f"so '{first}' stands for both.",
                )
            )
    return tuple(decisions)
