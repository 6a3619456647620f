"""cobot-lfd scenes, cobot-lfd robots: what there is, and what works where."""

from cobot_lfd.app.commands.exit_codes import DONE
from cobot_lfd.app.reach import reached_share
from robots import Kinematics, RobotDescription, has_urdf, load_robot, robot_names, tool_names
from scenes import load_scene, scene_names, variant_names

_N_LAYOUTS = 5  # that are tried for each scene and robot


def scenes() -> int:
    """List the scenes, each with its tool and the robots that reach its objects."""
    for name in scene_names():
        scene = load_scene(name)
        print(f"{name}: {scene.title}", flush=True)
        print(f"  tool: {scene.task.tool}; in reach of: {', '.join(_reached_by(name))}", flush=True)
    print(f"variants of every scene, named as in {scene_names()[0]}@{variant_names()[0]}:", end=" ")
    print(", ".join(variant_names()))
    return DONE


def robots() -> int:
    """List the robots, each with its number of joints and where its URDF comes from."""
    for name in robot_names():
        robot = load_robot(name)
        note = "" if _installed(robot) else "; not installed: pip install 'cobot-lfd[robots]'"
        print(f"{name}: {robot.title} ({len(robot.joints)} joints{note})")
    print(f"tools that go on every robot: {', '.join(tool_names())}")
    return DONE


def _reached_by(scene_name: str) -> list[str]:
    """The robots that reach a scene's objects, each with the share of layouts where that is not all."""
    scene = load_scene(scene_name)
    told = []
    for name in robot_names():
        robot = load_robot(name, scene.task.tool)
        if not _installed(robot):
            continue
        with Kinematics(robot) as kinematics:
            share = reached_share(kinematics, robot, scene, n_layouts=_N_LAYOUTS)
        if share > 0.0:
            told.append(name if share == 1.0 else f"{name} ({100 * share:.0f} % of layouts)")
    return told


def _installed(robot: RobotDescription) -> bool:
    return has_urdf(robot.urdf, robot.package)
