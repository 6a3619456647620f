"""How an episode ended: a kind that can be counted, and a sentence that a person can read.

A failed episode is not an exception but a result: whatever happens to one episode, a recording session or an
evaluation goes on, and says afterwards what happened how often.
"""

from dataclasses import dataclass
from enum import Enum, unique


@unique
class Outcome(Enum):
    """How an episode ended; the value is the sentence that users read.

    Files and summaries name an outcome by its ``kind``, so that a sentence can be improved without breaking
    them.
    """

    SUCCESS = "the task is done"
    OBJECT_NOT_SEEN = "the camera does not see an object that the task needs"
    UNREACHABLE_POSE = "the arm cannot reach a pose that the task needs"
    IK_NOT_CONVERGED = "inverse kinematics found no joint positions close enough to a pose"
    LIMITS_VIOLATED = "the motion would break a limit of the arm"
    PATH_LEAVES_WORKSPACE = "the generated path leaves the workspace"
    COLLISION = "the arm would hit something"
    GRASP_FAILED = "the gripper did not get hold of the part"
    GRASP_LOST = "the part slipped out of the gripper on the way"
    NOT_PLACED = "the part does not lie where it belongs"
    NOT_AT_REST = "the part does not come to rest"
    HARD_CONTACT = "something was hit harder than it may be"
    NOT_RELEASED = "the gripper still touches the part"
    TIMEOUT = "the time for the episode is over"
    TRACKING_LOST = "the arm did not follow the planned motion"
    HAND_COULD_NOT_FINISH = "the hand could not finish the demonstration"
    INCOMPLETE = "the recording was stopped before its end"
    GENERATION_FAILED = "the model gives no usable path for this scene"
    CRASHED = "the process that ran the episode died"
    INTERNAL_ERROR = "the program failed; this is a fault in it, please report it"

    @property
    def kind(self) -> str:
        """The name under which files and summaries count this outcome, such as ``object_not_seen``."""
        return self.name.lower()

    @classmethod
    def from_kind(cls, kind: str) -> "Outcome":
        """The outcome that is counted under a name.

        Raises:
            ValueError: If no outcome is called so.
        """
        by_kind = {outcome.kind: outcome for outcome in cls}
        if kind not in by_kind:
            raise ValueError(f"no outcome is called {kind!r}; choose one of: {', '.join(by_kind)}.")
        return by_kind[kind]


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is said about one episode: how it ended, and what it was in particular.

    Attributes:
        outcome: How the episode ended.
        detail: What it was in this episode ("cube: no blue region of its size"); empty where there is no more
            to say.
    """

    outcome: Outcome
    detail: str = ""

    @property
    def succeeded(self) -> bool:
        """Whether the task was done."""
        return self.outcome is Outcome.SUCCESS

    @property
    def sentence(self) -> str:
        """The outcome's sentence, with the detail appended after a colon."""
        return f"{self.outcome.value}: {self.detail}" if self.detail else self.outcome.value
