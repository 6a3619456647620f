"""cobot-lfd record: demonstrations into a folder."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE, NOT_ALL_SUCCEEDED
from cobot_lfd.app.commands.options import require_at_least, require_positive
from cobot_lfd.app.progress import progress
from cobot_lfd.app.recording.record import record_session
from cobot_lfd.errors import CobotError

if TYPE_CHECKING:
    from cobot_lfd.app.studio.session import Session


def record(
    scene: Positional[str],
    *,
    out: Path,
    robot: str = "panda",
    hand: Literal["scripted", "browser", "mouse"] = "scripted",
    demos: int = 6,
    seed: int = 0,
    camera: Path | None = None,
    port: int | None = None,
    host: str | None = None,
    open: bool = True,  # noqa: A002 -- the option is called --no-open
) -> int:
    """Record demonstrations: a hand leads the compliant arm through the task.

    Args:
        scene: Name of the scene; see 'cobot-lfd scenes'.
        out: Folder for the demonstrations. What is in it already stays; seeds that it has are left out.
        robot: Name of the robot; see 'cobot-lfd robots'.
        hand: Who leads: a script, or a person: in a browser, or with the mouse in the simulator's window.
        demos: How many demonstrations the script shows; a person records until the person ends it.
        seed: Of the first demonstration; each further one has the next.
        camera: File of a calibrated camera (cobot-lfd calibrate), by which pictures are read.
        port: Of the page in the browser; a free one by default.
        host: Serve the page on this address of the machine, for other machines; it asks for a token then.
        open: Open the page in the browser.
    """
    require_positive("demos", demos)
    require_at_least(0, "seed", seed)
    if hand == "browser":
        if camera is not None:
            raise CobotError(
                "--camera needs --hand scripted; name the file in the scene: camera.calibration."
            )
        return _in_browser(scene, robot, out, seed, port=port, host=host, show=open)
    if hand == "mouse":
        return _in_window(scene, robot, out, seed)
    with progress("recording", demos) as report:
        episodes = record_session(
            scene, robot, out, n_episodes=demos, first_seed=seed, report=report, camera=camera
        )
    kept = sum(episode.verdict.succeeded for episode in episodes)
    print(f"{kept} of {demos} demonstrations did the task; they are in {out}")
    return DONE if kept == demos else NOT_ALL_SUCCEEDED


def _in_browser(
    scene: str, robot: str, out: Path, seed: int, *, port: int | None, host: str | None, show: bool
) -> int:
    """The recording studio; it is imported here because it takes longer to import than all the rest."""
    from cobot_lfd.app.studio.launch import open_studio

    session = open_studio(scene, robot, out, first_seed=seed, port=port, host=host, show=show)
    return _told(session, out)


def _in_window(scene: str, robot: str, out: Path, seed: int) -> int:
    """The same in the simulator's window."""
    from cobot_lfd.app.studio.window import open_window

    return _told(open_window(scene, robot, out, first_seed=seed), out)


def _told(session: "Session", out: Path) -> int:
    """Say what a person recorded."""
    kept = session.kept
    print(f"demonstrations in {out}: {len(kept.episodes)}, of which {len(kept.good)} did the task")
    return DONE
