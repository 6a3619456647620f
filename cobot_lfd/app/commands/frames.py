"""cobot-lfd frames: which frames the demonstrations show to matter, and why."""

from pathlib import Path

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE
from cobot_lfd.app.demonstrations.store import load_kept
from cobot_lfd.app.discovery.camera import camera_of
from cobot_lfd.app.discovery.discover import discover
from cobot_lfd.app.discovery.picture import draw_discovery
from cobot_lfd.app.discovery.told import told
from cobot_lfd.app.pictures.plot import require_plot_file


def frames(demos: Positional[Path], *, out: Path | None = None) -> int:
    """Find the frames that matter in the pictures and paths of demonstrations alone.

    What the recordings say about objects is not used: candidates are what stands out from the table in the
    pictures and reappears, and the robot's base, which never moves.

    Args:
        demos: Folder of demonstrations.
        out: File (.png, .svg or .pdf) for a picture of what was found in each demonstration.
    """
    if out is not None:
        require_plot_file(out)
    episodes = load_kept(demos)
    discovery = discover(episodes, camera_of(episodes))
    print(told(discovery))
    if out is not None:
        print(f"the picture is in {draw_discovery(discovery, episodes, camera_of(episodes), out)}")
    return DONE
