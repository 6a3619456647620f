"""cobot-lfd record: demonstrations into a folder."""

from pathlib import Path

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE, NOT_ALL_SUCCEEDED
from cobot_lfd.app.commands.options import require_positive
from cobot_lfd.app.progress import progress
from cobot_lfd.app.record import record_session


def record(scene: Positional[str], *, out: Path, robot: str = "panda", demos: int = 6, seed: int = 0) -> int:
    """Record demonstrations: a scripted hand leads the compliant arm through the task.

    Args:
        scene: Name of the scene; see 'cobot-lfd scenes'.
        out: Folder for the demonstrations. What is in it already stays; seeds that it has are left out.
        robot: Name of the robot; see 'cobot-lfd robots'.
        demos: How many demonstrations.
        seed: Of the first demonstration; each further one has the next.
    """
    require_positive("demos", demos)
    with progress("recording", demos) as report:
        episodes = record_session(scene, robot, out, n_episodes=demos, first_seed=seed, report=report)
    kept = sum(episode.verdict.succeeded for episode in episodes)
    print(f"{kept} of {demos} demonstrations did the task; they are in {out}")
    return DONE if kept == demos else NOT_ALL_SUCCEEDED
