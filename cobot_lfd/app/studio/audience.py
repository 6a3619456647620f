"""Who sees what happens in the studio, and in which mode it is."""

from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

from cobot_lfd.app.perceive import View
from scenes import World

if TYPE_CHECKING:
    from cobot_lfd.app.studio.session import Session
    from cobot_lfd.app.studio.stage import Stage


class Mode(Enum):
    """What is going on; the value is what the page says."""

    WORKING = "one moment ..."
    READY = "ready: press Start [R], then drag the tool"
    RECORDING = "recording: drag the tool through the task, then press Stop [T]"
    STOPPED = "kept: go on with the next scene [N], or discard it"
    REPLAYING = "replaying"
    TRYING = "the arm performs the task as it has learnt it"


class Audience(Protocol):
    """The page, or a test."""

    def scene_changed(self, world: World, robot_body: int, view: View) -> None:
        """Other objects stand on the table."""

    def moved(self, client: Any, stage: "Stage") -> None:
        """Time has passed; called some thirty times in a second."""

    def changed(self, session: "Session") -> None:
        """Something else is to be seen: the mode, the list of what is kept, what was learnt."""

    def said(self, sentence: str, *, bad: bool = False) -> None:
        """The session has something to say."""
