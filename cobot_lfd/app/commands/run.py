"""cobot-lfd run: one new scene, from the picture to the checked success."""

from contextlib import nullcontext
from pathlib import Path

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE, NOT_ALL_SUCCEEDED
from cobot_lfd.app.commands.options import require_at_least
from cobot_lfd.app.demonstrations.store import load_kept
from cobot_lfd.app.discovery.recognised import demonstrations_of
from cobot_lfd.app.episode import Bench, EpisodeRun, run_episode
from cobot_lfd.app.evaluate import Job, bench_for
from cobot_lfd.app.pictures.draw import require_picture_file, save_picture
from cobot_lfd.app.pictures.film import filming
from cobot_lfd.app.pictures.illustrate import drawn_view
from cobot_lfd.app.pictures.plot import plot_model, require_plot_file
from cobot_lfd.detection import Detection
from cobot_lfd.motion import TimingMethod


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
    covered: bool = False,
    camera: Path | None = None,
    compliant: bool = False,
    timing: TimingMethod = "simple",
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
        covered: Cover the camera's lens; the episode can then not succeed.
        camera: File of a calibrated camera (cobot-lfd calibrate), by which the picture is read.
        compliant: Let the arm give way during the carry where the demonstrations strayed.
        timing: How the motion along the path gets its times: simple, or near_optimal, which is faster and
            takes longer to compute.
    """
    require_at_least(0, "seed", seed)
    if picture:
        require_picture_file(picture)
    if plot:
        require_plot_file(plot)
    bench = bench_for(Job(scene, robot, model, covered, compliant, timing, camera))
    with filming(video) if video else nullcontext() as film:
        episode = run_episode(bench, seed, film=film)
    print(f"seed {seed}: {episode.result.verdict.sentence}")
    for file in _illustrate(bench, episode, picture=picture, plot=plot, demos=demos):
        print(f"  {file}")
    if video:
        print(f"  {video}")
    return DONE if episode.result.verdict.succeeded else NOT_ALL_SUCCEEDED


def _illustrate(
    bench: Bench, episode: EpisodeRun, *, picture: Path | None, plot: Path | None, demos: Path | None
) -> list[Path]:
    """Draw what is asked for and can be drawn; returns the files."""
    files = []
    path = episode.path
    if picture:
        drawn = drawn_view(bench.scene, episode.view, path, detour=episode.detour)
        files.append(save_picture(drawn, picture))
    if plot and path is not None:
        demonstrations = demonstrations_of(bench.model, load_kept(demos)) if demos else []
        found = episode.view.find_for(bench.model)
        frames = {name: seen.frame for name, seen in found.items() if isinstance(seen, Detection)}
        files.append(plot_model(demonstrations, frames, path, file=plot, kinds=bench.model.frame_kinds))
    return files
