"""Frame discovery on every scene with clutter: in how many training sets the frames that matter are found.

A set is right when every object that the task's waypoints refer to and that the camera sees has exactly one
kept frame, which lies at one place of it in all demonstrations; when nothing else on the table is kept; and
when the base is kept if, and only if, a waypoint refers to what stands still outside the camera's view.

Demonstrations are either as the scripted hand wants them (a picture of the scene with the arm, and the hand's
path with its bow, timing and tremor; no physics, so that hundreds can be had), or sets drawn from folders of
recorded ones. A line per set is written as it ends; the same command goes on where it was.
"""

import json
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
import tyro
from tyro.conf import Positional

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.store import load_kept
from cobot_lfd.app.discovery.camera import camera_of
from cobot_lfd.app.discovery.candidates import BASE
from cobot_lfd.app.discovery.discover import Discovery, discover
from cobot_lfd.app.recording.sketch import sketch_episode
from cobot_lfd.errors import CobotError
from cobot_lfd.frame import Frame, wrap_angle
from scenes import SceneDescription, draw_placements, load_scene, scene_names

ROBOT = "panda"
MOST_SPREAD = 0.004, np.deg2rad(4.0)  # Of an object as seen from its frame over the demonstrations [m], [rad]
FARTHEST = 0.01  # [m] of a frame whose direction is not known from the middle of its object


@dataclass(frozen=True, slots=True)
class Job:
    """One training set.

    Attributes:
        scene: Name of the scene, with its variant.
        number: Of the set.
        n_demonstrations: How many demonstrations it has.
        folder: Folder of recorded demonstrations that it is drawn from; empty for a fresh, scripted set.
        first_seed: Of a fresh set's first demonstration.
    """

    scene: str
    number: int
    n_demonstrations: int
    folder: str
    first_seed: int


@dataclass(frozen=True, slots=True)
class Row:
    """What came out of one training set.

    Attributes:
        scene: Name of the scene.
        number: Of the set.
        fault: What is wrong; empty where it is right.
        kept: The kept frames.
        error_mm: Mean distance of left-out demonstrations from what is predicted with them [mm].
        spread_mm: Largest spread of an object as seen from its frame [mm].
    """

    scene: str
    number: int
    fault: str
    kept: str
    error_mm: float
    spread_mm: float


def main(
    out: Positional[Path],
    *,
    scenes: tuple[str, ...] = (),
    variant: str = "clutter",
    sets: int = 30,
    demos: int = 6,
    recorded: Path | None = None,
    seed: int = 60_000,
    workers: int = 1,
) -> int:
    """Run the sets that are missing in a file, and print the table of all that are in it.

    Args:
        out: File for a line of JSON per set.
        scenes: Names of the scenes; all by default.
        variant: Variant of the scenes.
        sets: Number of training sets of each scene.
        demos: Demonstrations in a set.
        recorded: Folder with a folder of recorded demonstrations per scene, from which the sets are drawn.
        seed: Of the first demonstration of the first set, where nothing is recorded; each further one has the
            next. Nothing was tuned on those from 60000 on.
        workers: Processes.
    """
    names = [f"{name}@{variant}" for name in scenes or scene_names()]
    folder = {name: str(recorded / name.partition("@")[0]) if recorded else "" for name in names}
    for name in names if recorded else ():
        if fault := _unfit(name, folder[name], demos):
            print(f"{fault} Or leave the scene out: --scenes.", file=sys.stderr)
            return 2
    done = {(row.scene, row.number) for row in _read(out)}
    jobs = [
        Job(name, n, demos, folder[name], seed + n * demos)
        for n in range(sets)
        for name in names
        if (name, n) not in done
    ]
    out.parent.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(workers) as pool, out.open("a", encoding="utf-8") as file:
        for future in as_completed([pool.submit(run, job) for job in jobs]):
            file.write(json.dumps(asdict(future.result())) + "\n")
            file.flush()
    print(table([row for row in _read(out) if row.scene in names]))
    return 0


def run(job: Job) -> Row:
    """Find the frames in one training set, and compare them with the truth."""
    scene = load_scene(job.scene)
    episodes, truth = _recorded(job, scene) if job.folder else _scripted(job, scene)
    try:
        found = discover(episodes, camera_of(episodes))
    except CobotError as error:
        return Row(job.scene, job.number, str(error), "", float("nan"), float("nan"))
    fault, spread = judge(found, scene, truth)
    left_out = 1e3 * float(found.choice.errors.mean())
    return Row(job.scene, job.number, fault, " ".join(found.kept), round(left_out, 2), round(1e3 * spread, 2))


def judge(found: Discovery, scene: SceneDescription, truth: Sequence[dict[str, Frame]]) -> tuple[str, float]:
    """What is wrong with the kept frames, and the largest spread of an object seen from its frame [m]."""
    needed = {waypoint.frame for waypoint in scene.task.waypoints}
    moving = {name for name in needed if scene.objects[name].seen}
    of_object = defaultdict(list)
    spreads = [0.0]
    for name in found.kept:
        if name == BASE:
            continue
        frames = [demonstration.frames[name] for demonstration in found.demonstrations]
        symmetric = found.candidates.tracks[name].symmetry > 1
        spread, nearest = min((_spread(frames, [t[o] for t in truth], symmetric), o) for o in truth[0])
        of_object[nearest if spread < MOST_SPREAD[0] else "nothing"].append(name)
        spreads.append(spread)
    faults = [
        f"{name} has {len(of_object[name])} frames" for name in sorted(moving) if len(of_object[name]) != 1
    ]
    faults += [f"a frame of {name} is kept" for name in of_object if name not in moving]
    if (BASE in found.kept) != (moving != needed):
        faults.append("the base is kept" if BASE in found.kept else "the base is dropped")
    return "; ".join(faults), max(spreads)


def _spread(frames: Sequence[Frame], truth: Sequence[Frame], symmetric: bool) -> float:
    """How far an object's place, as seen from a frame, is from constant [m]; infinite for a turned one."""
    if symmetric:
        apart = np.array(
            [np.linalg.norm(f.position - t.position) for f, t in zip(frames, truth, strict=True)]
        )
        return float(apart.max()) if apart.max() < FARTHEST else np.inf
    relative = [f.inverse() @ t for f, t in zip(frames, truth, strict=True)]
    places = np.array([pose.position for pose in relative])
    turns = max(abs(wrap_angle(pose.angle - relative[0].angle)) for pose in relative)
    spread = float(np.linalg.norm(places - places.mean(axis=0), axis=1).max())
    return spread if turns < MOST_SPREAD[1] else np.inf


def _scripted(job: Job, scene: SceneDescription) -> tuple[list[RecordedEpisode], list[dict[str, Frame]]]:
    """Demonstrations as the hand wants them; every set has seeds of its own."""
    seeds = range(job.first_seed, job.first_seed + job.n_demonstrations)
    pairs = [sketch_episode(job.scene, scene, ROBOT, seed) for seed in seeds]
    return [episode for episode, _ in pairs], [dict(frames) for _, frames in pairs]


def _recorded(job: Job, scene: SceneDescription) -> tuple[list[RecordedEpisode], list[dict[str, Frame]]]:
    """A set drawn from a folder; where the objects stood follows from each demonstration's seed."""
    pool = _pool(job.folder)
    chosen = np.random.default_rng(job.number).choice(len(pool), job.n_demonstrations, replace=False)
    episodes = [pool[i] for i in sorted(chosen)]
    return episodes, [dict(draw_placements(scene, np.random.default_rng(e.seed))) for e in episodes]


def _unfit(scene: str, folder: str, n_demonstrations: int) -> str:
    """Why no sets of a scene can be drawn from a folder; empty if they can."""
    try:
        pool = _pool(folder)
    except CobotError as error:
        return str(error)
    others = {episode.scene for episode in pool} - {scene}
    if others:
        return f"{folder} holds demonstrations of {', '.join(sorted(others))}, not of {scene}; record some."
    if len(pool) < n_demonstrations:
        return f"{folder} holds {len(pool)} demonstrations; a set needs {n_demonstrations}: record more."
    return ""


@lru_cache(maxsize=8)
def _pool(folder: str) -> list[RecordedEpisode]:
    return load_kept(Path(folder))


def _read(file: Path) -> Iterator[Row]:
    if file.exists():
        for line in file.read_text(encoding="utf-8").splitlines():
            yield Row(**json.loads(line))


def table(rows: Sequence[Row]) -> str:
    """A line per scene, in Markdown."""
    lines = [
        "| scene | sets | right | error of left-out demonstrations | frame off its object's place, worst |",
        "| --- | --- | --- | --- | --- |",
    ]
    for scene in sorted({row.scene for row in rows}):
        mine = [row for row in rows if row.scene == scene]
        right = [row for row in mine if not row.fault]
        lines.append(
            f"| {scene} | {len(mine)} | {len(right)} | {np.median([r.error_mm for r in mine]):.1f} mm | "
            f"{max((r.spread_mm for r in right), default=np.nan):.1f} mm |"
        )
    lines += [f"- {row.scene}, set {row.number}: {row.fault} ({row.kept})" for row in rows if row.fault]
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
