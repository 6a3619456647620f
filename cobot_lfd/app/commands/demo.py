"""cobot-lfd demo: the main job from beginning to end."""

from pathlib import Path

from cobot_lfd.app.commands.evaluate import evaluate
from cobot_lfd.app.commands.exit_codes import NOT_ALL_SUCCEEDED
from cobot_lfd.app.commands.fit import fit
from cobot_lfd.app.commands.record import record
from cobot_lfd.app.commands.report import report
from cobot_lfd.app.commands.run import run

_SHOWN = {
    "camera.png": "what the camera saw, with the detected frames and the generated path",
    "path.png": "the demonstrations, and the generated path with its covariance",
    "run.webm": "the arm doing it",
    "comparison/report.html": "the comparison with conventional TP-GMM/R, to look at in a browser",
    "comparison/results.jsonl": "a line per episode of it",
}


def demo(
    *,
    scene: str = "ball_in_hole",
    robot: str = "panda",
    out: Path = Path("demo"),
    demos: int = 6,
    episodes: int = 20,
    seed: int = 0,
    workers: int = 2,
) -> int:
    """Do the main job: record, learn, perform a new scene, compare methods in more, show the files to open.

    Args:
        scene: Name of the scene.
        robot: Name of the robot.
        out: Folder for everything; if it is there, the next free name is taken (demo-2, demo-3, ...).
        demos: How many demonstrations.
        episodes: In how many more new scenes the improved and the conventional method are compared.
        seed: Of the first demonstration; new scenes have seeds from 1000 on.
        workers: How many episodes run at once.
    """
    folder = _free_folder(out)
    model, new_seed = folder / "model.npz", seed + 1000
    codes = [record(scene, out=folder / "demos", robot=robot, demos=demos, seed=seed)]
    codes.append(fit(folder / "demos", out=model))
    codes.append(
        run(
            model,
            scene=scene,
            robot=robot,
            seed=new_seed,
            picture=folder / "camera.png",
            plot=folder / "path.png",
            demos=folder / "demos",
            video=folder / "run.webm",
        )
    )
    compared = evaluate(
        method=("improved", "conventional"),
        demos=folder / "demos",
        scene=(scene,),
        robot=(robot,),
        out=folder / "comparison",
        episodes=episodes,
        seed=new_seed + 1,
        workers=workers,
    )
    if compared > NOT_ALL_SUCCEEDED:  # that one method fails is what a comparison may show
        codes.append(compared)
    report((folder / "comparison",))
    print("\nOpen these:")
    for name, what in _SHOWN.items():
        print(f"  {folder / name}: {what}")
    return max(codes)


def _free_folder(folder: Path) -> Path:
    """The folder itself, or the first of folder-2, folder-3, ... that is not there."""
    number, free = 1, folder
    while free.exists():
        number += 1
        free = folder.with_name(f"{folder.name}-{number}")
    return free
