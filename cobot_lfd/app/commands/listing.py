"""cobot-lfd scenes, cobot-lfd robots: what there is."""

from cobot_lfd.app.commands.exit_codes import DONE
from robots import load_robot, robot_names
from scenes import load_scene, scene_names


def scenes() -> int:
    """List the scenes."""
    for name in scene_names():
        print(f"{name}: {load_scene(name).title}")
    return DONE


def robots() -> int:
    """List the robots."""
    for name in robot_names():
        print(f"{name}: {load_robot(name).title}")
    return DONE
