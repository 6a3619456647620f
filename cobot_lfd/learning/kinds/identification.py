"""Which kind each frame is of, how sure that is, and why, in sentences."""

from dataclasses import dataclass
from enum import Enum

from cobot_lfd.arrays import Array
from cobot_lfd.frame import FrameKind
from cobot_lfd.learning.data import TaskData
from cobot_lfd.learning.kinds.bearing import BearingTest, bearing_evidence


class Certainty(Enum):
    """How a frame's kind came about."""

    GIVEN = "given by the user"
    FOUND = "found in the demonstrations"
    UNDECIDED = "undecided"
    ASSUMED = "assumed"


@dataclass(frozen=True, slots=True)
class Finding:
    """What was found about one frame.

    Attributes:
        name: The frame.
        kind: The kind that the model uses.
        certainty: How it came about.
        evidence: Log-likelihood ratio in favour of a direction [nat]; 0 where none was computed.
        reason: Why, as a sentence for the user.
    """

    name: str
    kind: FrameKind
    certainty: Certainty
    evidence: float
    reason: str


def identify_by_bearing(data: TaskData, test: BearingTest) -> list[Finding]:
    """The kinds by the bearing likelihood ratio; close calls are marked as undecided."""
    if len(data.names) == 1:
        reason = f"'{data.names[0]}' is the only frame, so only its axes can tell the path's direction"
        return [Finding(data.names[0], FrameKind.ORIENTED, Certainty.ASSUMED, 0.0, reason + ".")]
    if len(data.paths) < 2:
        reason = "counts as oriented: one demonstration cannot show whether its direction matters."
        return [
            Finding(name, FrameKind.ORIENTED, Certainty.ASSUMED, 0.0, f"'{name}' {reason}")
            for name in data.names
        ]
    evidence = bearing_evidence(data, test)
    return [_judge(name, trace, data, test) for name, trace in zip(data.names, evidence, strict=True)]


def _judge(name: str, trace: Array, data: TaskData, test: BearingTest) -> Finding:
    """One frame's kind from its evidence over time."""
    n = len(data.paths)
    evidence, place = float(trace.max()), data.times[int(trace.argmax())]
    oriented = evidence > test.margin * n
    kind = FrameKind.ORIENTED if oriented else FrameKind.ORIENTATION_LESS
    told = f"evidence {evidence:.1f} nat at {place:.0%} of the time, {test.margin * n:.1f} needed"
    if n < 3 or abs(evidence - test.margin * n) < test.doubt * n:
        reason = (
            f"'{name}' is undecided and counts as {kind.value} for now ({told}); record another "
            f"demonstration with '{name}' turned to a direction not shown yet."
        )
        return Finding(name, kind, Certainty.UNDECIDED, evidence, reason)
    says = (
        f"'{name}' is oriented: seen in its own axes the path keeps its direction between demonstrations"
        if oriented
        else f"'{name}' is orientation-less: its axes do not predict where the path lies"
    )
    return Finding(name, kind, Certainty.FOUND, evidence, f"{says} ({told}).")
