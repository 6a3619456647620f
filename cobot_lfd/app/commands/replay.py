"""cobot-lfd replay: one episode of an evaluation once more, to look at."""

from pathlib import Path

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE, NOT_ALL_SUCCEEDED
from cobot_lfd.app.disk import write_file
from cobot_lfd.app.episode import run_episode
from cobot_lfd.app.evaluation.perform import bench_of, film
from cobot_lfd.app.pictures.draw import save_picture
from cobot_lfd.app.pictures.illustrate import drawn_view
from cobot_lfd.app.run_folder import RunFolder


def replay(
    run: Positional[Path], trial: Positional[int], *, picture: Path | None = None, video: Path | None = None
) -> int:
    """Run one episode of an evaluation again, just as it was.

    Args:
        run: Folder of the evaluation.
        trial: Number of the episode in its plan.
        picture: File (.png) for what the camera saw, with the detected frames and the path drawn on it.
        video: File (.webm) for a video of the arm.
    """
    folder = RunFolder.open(run)
    one = folder.plan.trial(trial)
    folder.require_unchanged()
    bench = bench_of(one)
    episode = run_episode(bench, one.seed)
    print(f"{one.contender.label}, seed {one.seed}: {episode.result.verdict.sentence}")
    if picture:
        drawn = drawn_view(bench.scene, episode.view, episode.path, detour=episode.detour)
        print(f"  {save_picture(drawn, picture)}")
    if video:
        write_file(video, film(one))
        print(f"  {video}")
    return DONE if episode.result.verdict.succeeded else NOT_ALL_SUCCEEDED
