"""How precisely objects are found, in good and bad conditions, beside ArUco markers at the same poses.

One command prints the whole table. The pictures are those of the scene pick_and_place with three printed
boxes added, all put at random places; in each picture the cube and the container are found by colour and
outline, the printed boxes by SIFT (in two conditions by ORB, too), and then, in the same picture with markers
drawn where the objects stand, as large as there is room for, all of them by ArUco. Errors are against the
simulator's poses; times are processor time of a core, rendering excluded. In the end cameras are calibrated.
"""

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from time import process_time

import cv2
import numpy as np
import tyro

from cobot_lfd.app.calibrate import calibrate
from cobot_lfd.app.evaluation.workers import WorkerProcesses
from cobot_lfd.app.sought import sought
from cobot_lfd.camera import Camera
from cobot_lfd.detection import NotSeen
from cobot_lfd.frame import Frame
from perception import Detector, FeatureDetector, MarkerDetector, ShapeDetector
from perception.picture import Picture
from robots import load_robot
from scenes import SceneDescription, World, load_scene
from scenes.placement import draw_placements
from tools.perception_conditions import CONDITIONS, DISTORTION, PRINTED, scene_of, spoiler, varied_light
from tools.perception_markers import marker_for, with_markers

WRONG_MM = 10.0  # What is this far from the truth is another thing [mm].
CHUNK = 50  # Pictures that one process takes at a time.


@dataclass(frozen=True, slots=True)
class Result:
    """One object in one picture.

    Attributes:
        row: What was found, and how.
        errors: In x [m], y [m] and angle [rad]; None if it was not found.
        normalised: Errors squared, by the covariance that was given with them; 3 on average if that is right.
        seconds: Time that it took to find all objects of the picture [s].
    """

    row: str
    errors: list[float] | None
    normalised: float
    seconds: float


def main(
    pictures: int = 500,
    seed: int = 0,
    only: tuple[str, ...] = (),
    workers: int = 1,
    calibrations: int = 5,
    keep: Path | None = None,
) -> int:
    """Print the table.

    Args:
        pictures: Number of pictures per condition.
        seed: Decides where the objects stand and how the conditions vary.
        only: Conditions to be measured; all of them if empty.
        workers: How many processes measure; the figures, times aside, do not depend on it.
        calibrations: How many cameras are calibrated.
        keep: Folder for what was measured; what is in it already is not measured again. By default none.
    """
    unknown = set(only) - set(CONDITIONS)
    if unknown:
        raise SystemExit(f"no condition {sorted(unknown)}; choose from: {', '.join(CONDITIONS)}.")
    head = ["condition", "found", "n", "found %", "wrong", "mm median", "mm 99 %", "° median", "° 99 %"]
    print("| " + " | ".join([*head, "error² / 3σ²", "ms a picture"]) + " |")
    print("| --- | --- |" + " ---: |" * 9, flush=True)
    chunks = [(first, min(CHUNK, pictures - first)) for first in range(0, pictures, CHUNK)]
    with WorkerProcesses(workers, time_limit=3600.0) as pool:
        for name in CONDITIONS:
            if not only or name in only:
                measured = pool.map(partial(measured_or_kept, keep, name, seed), *zip(*chunks, strict=True))
                results = [result for part in measured for result in part]
                for row in dict.fromkeys(result.row for result in results):
                    chosen = [result for result in results if result.row == row]
                    print(f"| {name} | {row} | {as_text(chosen)} |", flush=True)
        if calibrations:
            print_calibrations(pool, range(seed, seed + calibrations))
    return 0


def as_text(results: Sequence[Result]) -> str:
    """The numbers of a row of the table."""
    errors = np.array([r.errors for r in results if r.errors is not None]).reshape(-1, 3)
    if not len(errors):
        return f"{len(results)} | 0.0 | 0 |" + " |" * 5 + " "
    mm, degrees = 1e3 * np.linalg.norm(errors[:, :2], axis=1), np.rad2deg(np.abs(errors[:, 2]))
    normalised = np.mean([r.normalised for r in results if r.errors is not None]) / 3
    numbers = [*np.percentile(mm, [50, 99]), *np.percentile(degrees, [50, 99]), normalised]
    cells = [f"{len(results)}", f"{100 * len(mm) / len(results):.1f}", f"{np.sum(mm > WRONG_MM)}"]
    cells += [f"{number:.2f}" for number in numbers]
    return " | ".join([*cells, f"{1e3 * np.median([r.seconds for r in results]):.1f}"])


def measured_or_kept(keep: Path | None, name: str, seed: int, first: int, n: int) -> list[Result]:
    """The results for some of the pictures of one condition, from a folder if they are there."""
    if keep is None:
        return measure(name, seed, first, n)
    path = keep / f"{list(CONDITIONS).index(name)}-{seed}-{first}-{n}.json"
    if not path.exists():
        results = measure(name, seed, first, n)
        keep.mkdir(parents=True, exist_ok=True)
        unfinished = path.with_suffix(".part")
        unfinished.write_text(json.dumps([asdict(result) for result in results]))
        unfinished.replace(path)
    return [Result(**result) for result in json.loads(path.read_text())]


def measure(name: str, seed: int, first: int, n: int) -> list[Result]:
    """Find everything in some of the pictures of one condition, in every way."""
    cv2.setNumThreads(1)
    condition = CONDITIONS[name]
    scene, generator = scene_of(condition), np.random.default_rng([seed, first])
    camera, models = scene.camera.camera, sought(scene, condition.renderer)
    faces = tuple(model.appearance for model in models if model.appearance is not None)
    markers = tuple(marker_for(model, number) for number, model in enumerate(models))
    detectors: dict[str, Detector] = {
        "outline": ShapeDetector(tuple(model for model in models if model.found_by == "shape")),
        "SIFT": FeatureDetector(faces, "sift"),
    }
    if condition.orb:
        detectors["ORB"] = FeatureDetector(faces, "orb")
    results: list[Result] = []
    with World(scene, seed, renderer=condition.renderer) as world:
        for _ in range(n):
            frames = draw_placements(scene, generator)
            for object_name, frame in frames.items():
                world.place(object_name, frame)
            light = varied_light(generator) if condition.vary_light else None
            picture = world.take_picture(light=light)
            marked = with_markers(picture, camera, markers, frames, condition.samples)
            spoil = spoiler(condition, camera, models, frames, generator)
            picture, marked = spoil(picture), spoil(marked)
            for how, detector in detectors.items():
                results += find(how, detector, picture, camera, frames)
            results += find("ArUco", MarkerDetector(markers), marked, camera, frames)
    return results


def find(
    how: str, detector: Detector, picture: Picture, camera: Camera, frames: Mapping[str, Frame]
) -> Iterator[Result]:
    """Run a detector on a picture and compare what it finds with the truth."""
    began = process_time()
    found = detector.detect(picture, camera)
    seconds = process_time() - began
    for thing in found:
        row = f"{'prints' if thing.name in PRINTED else thing.name}, {how}"
        if isinstance(thing, NotSeen):
            yield Result(row, None, np.nan, seconds)
            continue
        truth, turn = frames[thing.name], 2 * np.pi / thing.symmetry
        angle = np.mod(thing.frame.angle - truth.angle + turn / 2, turn) - turn / 2
        errors = np.array([*(thing.frame.position - truth.position), angle])
        normalised = float(errors @ np.linalg.solve(thing.covariance, errors))
        yield Result(row, errors.tolist(), normalised, seconds)


def print_calibrations(pool: Executor, seeds: Sequence[int]) -> None:
    """Print a table of calibrated cameras, which are distorted and noisy."""
    print(
        "\n| camera | views | residual px | focal length % | principal point px | position mm | direction ° |"
    )
    print("| --- |" + " ---: |" * 6)
    for seed, line in zip(seeds, pool.map(calibrated, seeds), strict=True):
        print(f"| distorted, noisy, seed {seed} | {line} |", flush=True)


def calibrated(seed: int) -> str:
    """The figures of one calibration: 20 views, 4 samples a pixel."""
    content = load_scene("pick_and_place").model_dump()
    content["camera"] |= {"lens": {"distortion": DISTORTION, "blur": 0.5}, "sensor": {"noise": 3.0}}
    scene = SceneDescription.model_validate(content)
    session = calibrate(scene, load_robot("panda"), n_views=20, seed=seed)
    errors = session.errors()
    return (
        f"{session.n_views} | {session.found.residual:.3f} | {errors.focal_percent:.3f} | "
        f"{errors.principal_point_px:.2f} | {errors.position_mm:.2f} | {errors.angle_deg:.3f}"
    )


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
