"""The commands: each calls a library function, prints what came of it, and returns the exit code."""

from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from multiprocessing import get_context
from pathlib import Path
from typing import Literal

from tyro.conf import Positional

from cobot_lfd.app.draw import draw_detections, save_picture
from cobot_lfd.app.episode import Bench, EpisodeRun, run_episode
from cobot_lfd.app.evaluate import Job, bench_for
from cobot_lfd.app.film import filming
from cobot_lfd.app.plot import plot_model
from cobot_lfd.app.progress import progress
from cobot_lfd.app.record import record_session
from cobot_lfd.app.run_folder import RESULTS, evaluate_into
from cobot_lfd.app.store import load_demonstrations
from cobot_lfd.app.summary import Summary
from cobot_lfd.errors import CobotError
from cobot_lfd.learning.model import TaskParameterisedGMM
from robots import load_robot, robot_names
from scenes import load_scene, object_models, scene_names

DONE, NOT_ALL_SUCCEEDED = 0, 1


def record(scene: Positional[str], *, out: Path, robot: str = "panda", demos: int = 6, seed: int = 0) -> int:
    """Record demonstrations: a scripted hand leads the compliant arm through the task.

    Args:
        scene: Name of the scene; see 'cobot-lfd scenes'.
        out: Folder for the demonstrations. What is in it already stays; seeds that it has are left out.
        robot: Name of the robot; see 'cobot-lfd robots'.
        demos: How many demonstrations.
        seed: Of the first demonstration; each further one has the next.
    """
    _require_positive("demos", demos)
    with progress("recording", demos) as report:
        episodes = record_session(scene, robot, out, n_episodes=demos, first_seed=seed, report=report)
    kept = sum(episode.verdict.succeeded for episode in episodes)
    print(f"{kept} of {demos} demonstrations did the task; they are in {out}")
    return DONE if kept == demos else NOT_ALL_SUCCEEDED


def fit(
    demos: Positional[Path],
    *,
    out: Path,
    method: Literal["improved", "paper", "conventional"] = "improved",
    n_components: int = 4,
) -> int:
    """Learn a model from the demonstrations that did the task.

    Args:
        demos: Folder of demonstrations.
        out: File for the model, ending in .npz.
        method: The product's best configuration, the paper's, or conventional TP-GMM/R.
        n_components: Number of Gaussians, where the method fits mixtures.
    """
    demonstrations = load_demonstrations(demos)
    model = TaskParameterisedGMM.fit(demonstrations, method=method, n_components=n_components)
    out.parent.mkdir(parents=True, exist_ok=True)
    model.save(out)
    print(f"learnt from {len(demonstrations)} demonstrations ({method}):")
    for name, kind in model.frame_kinds.items():
        print(f"  frame {name}: {kind.value}")
    print(f"the model is in {out}")
    return DONE


def run(
    model: Positional[Path],
    *,
    scene: str,
    robot: str = "panda",
    seed: int = 0,
    picture: Path | None = None,
    plot: Path | None = None,
    demos: Path | None = None,
    video: Path | None = None,
) -> int:
    """Perform the task once, in the scene that the seed lays out.

    Args:
        model: File of the model.
        scene: Name of the scene.
        robot: Name of the robot.
        seed: Decides the scene's layout.
        picture: File (.png) for what the camera saw, with the detected frames and the path drawn on it.
        plot: File (.png, .svg or .pdf) for a plot of the demonstrations and the path with its covariance.
        demos: Folder of the demonstrations that are to be in the plot.
        video: File (.webm) for a video of the arm.
    """
    bench = bench_for(Job(scene, robot, model))
    with filming(video) if video else nullcontext() as film:
        episode = run_episode(bench, seed, film=film)
    print(f"seed {seed}: {episode.result.verdict.sentence}")
    for file in _illustrate(bench, episode, picture=picture, plot=plot, demos=demos):
        print(f"  {file}")
    if video:
        print(f"  {video}")
    return DONE if episode.result.verdict.succeeded else NOT_ALL_SUCCEEDED


def evaluate(
    model: Positional[Path],
    *,
    scene: str,
    out: Path,
    robot: str = "panda",
    episodes: int = 100,
    seed: int = 0,
    workers: int = 1,
    covered: bool = False,
    json: bool = False,
) -> int:
    """Perform the task in many new scenes and count how often it is done.

    Args:
        model: File of the model.
        scene: Name of the scene.
        out: New folder for the results: a line per episode, a summary, and where they come from.
        robot: Name of the robot.
        episodes: How many episodes.
        seed: Of the first episode; each further one has the next.
        workers: How many episodes run at once; the results do not depend on it.
        covered: Cover the camera's lens; no episode can then succeed.
        json: Print the summary as JSON.
    """
    _require_positive("episodes", episodes)
    _require_positive("workers", workers)
    job = Job(scene, robot, model, covered)
    with _executor(workers) as executor, progress("evaluating", episodes) as report:
        summary = evaluate_into(
            out,
            job,
            range(seed, seed + episodes),
            executor=executor,
            report=lambda result: report(f"seed {result.seed}: {result.verdict.sentence}"),
        )
    print(summary.to_json() if json else f"{summary.to_text()}\nthe results are in {out / RESULTS}")
    return _exit_code(summary)


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


def demo(
    *, out: Path = Path("demo"), demos: int = 6, episodes: int = 20, seed: int = 0, workers: int = 2
) -> int:
    """Do the main job: record, learn, perform one new scene, evaluate more, and show the files to open.

    Args:
        out: Folder for everything; if it is there, the next free name is taken (demo-2, demo-3, ...).
        demos: How many demonstrations.
        episodes: How many new scenes are evaluated.
        seed: Of the first demonstration; new scenes have seeds from 1000 on.
        workers: How many episodes run at once.
    """
    folder = _free_folder(out)
    model, new_seed = folder / "model.npz", seed + 1000
    scene, robot = "pick_and_place", "panda"
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
    codes.append(
        evaluate(
            model,
            scene=scene,
            robot=robot,
            out=folder / "evaluation",
            episodes=episodes,
            seed=new_seed + 1,
            workers=workers,
        )
    )
    print("\nOpen these:")
    for name, what in _SHOWN.items():
        print(f"  {folder / name}: {what}")
    return max(codes)


_SHOWN = {
    "camera.png": "what the camera saw, with the detected frames and the generated path",
    "path.png": "the demonstrations, and the generated path with its covariance",
    "run.webm": "the arm doing it",
    "evaluation/summary.json": "how often it went well",
    "evaluation/results.jsonl": "a line per evaluated episode",
}


def _illustrate(
    bench: Bench, episode: EpisodeRun, *, picture: Path | None, plot: Path | None, demos: Path | None
) -> list[Path]:
    """Draw what is asked for and can be drawn; returns the files."""
    files = []
    path = episode.path
    models = object_models(bench.scene)
    if picture:
        drawn = draw_detections(
            episode.view.picture,
            bench.scene.camera.camera,
            episode.view.detections,
            models=models,
            path=None if path is None else path.mean,
            path_z=next(model.z for model in models if model.name == bench.scene.task.pick),
        )
        files.append(save_picture(drawn, picture))
    if plot and path is not None:
        demonstrations = load_demonstrations(demos) if demos else []
        frames = {name: episode.view.frames[name] for name in bench.model.frame_kinds}
        files.append(plot_model(demonstrations, frames, path, file=plot, kinds=bench.model.frame_kinds))
    return files


def _executor(workers: int) -> AbstractContextManager[Executor | None]:
    """Processes that share nothing with this one; none for a single worker."""
    return nullcontext() if workers == 1 else ProcessPoolExecutor(workers, mp_context=get_context("spawn"))


def _exit_code(summary: Summary) -> int:
    return DONE if summary.successes == summary.episodes else NOT_ALL_SUCCEEDED


def _require_positive(option: str, value: int) -> None:
    if value < 1:
        raise CobotError(f"--{option} is {value}; it must be at least 1.")


def _free_folder(folder: Path) -> Path:
    """The folder itself, or the first of folder-2, folder-3, ... that is not there."""
    number, free = 1, folder
    while free.exists():
        number += 1
        free = folder.with_name(f"{folder.name}-{number}")
    return free
