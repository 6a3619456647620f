"""How precisely objects are found, in good and bad conditions, beside ArUco markers at the same poses.

One command prints the whole table. The pictures are those of the scene pick_and_place with three printed
boxes added, all put at random places; in each picture the cube and the container are found by colour and
outline, the printed boxes by SIFT and by ORB, and then, in the same picture with markers drawn where the
objects stand, as large as there is room for, all of them by ArUco. Errors are against the simulator's poses;
times are processor time of one core, rendering excluded. In the end cameras are calibrated.
"""

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from multiprocessing import get_context
from time import process_time
from typing import Any

import cv2
import numpy as np
import tyro
from matplotlib.path import Path as Polygon
from numpy.typing import NDArray

from cobot_lfd.app.calibrate import calibrate
from cobot_lfd.app.sought import sought
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from cobot_lfd.marker import Marker, marker_image
from perception import Detector, FeatureDetector, MarkerDetector, ShapeDetector
from perception.picture import Picture
from perception.silhouette import silhouette_hull
from robots import load_robot
from scenes import Renderer, SceneDescription, World, load_scene
from scenes.imperfections import on_sensor, through_lens
from scenes.placement import draw_placements
from scenes.rendering import sample_pattern
from scenes.view import Lens, Light, Sensor

WRONG_MM = 10.0  # What is this far from the truth is another thing [mm].
DARK, BRIGHT = 25, 230  # A marker's ink and paper, of 255.
DISTORTION = (-0.25, 0.08, 0.001, -0.002, 0.0)
CHUNK = 50  # Pictures that one process takes at a time.

_PRINTED = {
    "large board": ((0.10, 0.07, 0.02), {"kind": "circuit_board", "seed": 1}),
    "small board": ((0.06, 0.04, 0.02), {"kind": "circuit_board", "seed": 2}),
    "parcel": ((0.08, 0.05, 0.03), {"kind": "label", "seed": 1}),
}


@dataclass(frozen=True, slots=True)
class Condition:
    """What the pictures of a row are like.

    Attributes:
        renderer: What draws them.
        samples: Points of a pixel that are averaged.
        vary_light: Whether the lamp's place, colour and strength are drawn anew for every picture.
        vary_sensor: Whether noise, blur, exposure and colour cast are drawn anew for every picture.
        distortion: Of the lens.
        covered: Share of each object that something grey covers from one side.
        colours: Of cube and container, where they are not red and blue.
    """

    renderer: Renderer = "tiny"
    samples: int = 1
    vary_light: bool = False
    vary_sensor: bool = False
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    covered: float = 0.0
    colours: Mapping[str, str] = field(default_factory=dict)


CONDITIONS = {
    "clean": Condition(),
    "clean, EGL": Condition(renderer="egl"),
    "clean, 4 samples a pixel": Condition(samples=4),
    "noise, blur, exposure, cast, light varied": Condition(vary_light=True, vary_sensor=True),
    "the same, EGL": Condition(renderer="egl", vary_light=True, vary_sensor=True),
    "30 % covered": Condition(covered=0.3),
    "distorted lens": Condition(distortion=DISTORTION),
    "white cube, grey container, light varied": Condition(
        vary_light=True, colours={"cube": "white", "container": "grey"}
    ),
}


@dataclass(frozen=True, slots=True)
class Result:
    """One object in one picture.

    Attributes:
        row: What was found, and how.
        errors: In x [m], y [m] and angle [rad], shape (3,); None if it was not found.
        normalised: Errors squared, by the covariance that was given with them; 3 on average if that is right.
        seconds: Time that it took to find all objects of the picture [s].
    """

    row: str
    errors: Array | None
    normalised: float
    seconds: float


def main(
    pictures: int = 500,
    seed: int = 0,
    only: tuple[str, ...] = (),
    workers: int = 1,
    calibrations: int = 5,
) -> int:
    """Print the table.

    Args:
        pictures: Number of pictures per condition.
        seed: Decides where the objects stand and how the conditions vary.
        only: Conditions to be measured; all of them if empty.
        workers: How many processes measure; the figures, times aside, do not depend on it.
        calibrations: How many cameras are calibrated.
    """
    head = ["condition", "found", "n", "found %", "wrong", "mm median", "mm 99 %", "° median", "° 99 %"]
    print("| " + " | ".join([*head, "error² / 3σ²", "ms a picture"]) + " |")
    print("| --- | --- |" + " ---: |" * 9, flush=True)
    chunks = [(first, min(CHUNK, pictures - first)) for first in range(0, pictures, CHUNK)]
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        for name in CONDITIONS:
            if not only or name in only:
                measured = pool.map(partial(measure, name, seed), *zip(*chunks, strict=True))
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


def scene_of(condition: Condition) -> SceneDescription:
    """The scene, with printed boxes, under a condition."""
    content: dict[str, Any] = load_scene("pick_and_place").model_dump()
    place = {"x": (0.37, 0.63), "y": (-0.29, 0.29), "angle_deg": (-180.0, 180.0)}
    for name, (size, print_) in _PRINTED.items():
        printed = {"size": size, "print": print_, "colour": "white", "place": place}
        content["objects"][name] = content["objects"]["cube"] | printed
    for name in ("cube", "container"):
        content["objects"][name]["place"] = place
    for name, colour in condition.colours.items():
        content["objects"][name]["colour"] = colour
    content["camera"] |= {"samples": condition.samples, "lens": {"distortion": condition.distortion}}
    return SceneDescription.model_validate(content | {"centre_distance": 0.15})


def measure(name: str, seed: int, first: int, n: int) -> list[Result]:
    """Find everything in some of the pictures of one condition, in every way."""
    cv2.setNumThreads(1)
    condition = CONDITIONS[name]
    scene, generator = scene_of(condition), np.random.default_rng([seed, first])
    camera, models = scene.camera.camera, sought(scene, condition.renderer)
    plain = tuple(model for model in models if model.found_by == "shape")
    faces = tuple(model.appearance for model in models if model.appearance is not None)
    markers = tuple(marker_for(model, number) for number, model in enumerate(models))
    detectors: dict[str, Detector] = {
        "outline": ShapeDetector(plain),
        "SIFT": FeatureDetector(faces, "sift"),
        "ORB": FeatureDetector(faces, "orb"),
    }
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
        row = f"{'prints' if thing.name in _PRINTED else thing.name}, {how}"
        if isinstance(thing, NotSeen):
            yield Result(row, None, np.nan, seconds)
            continue
        truth, turn = frames[thing.name], 2 * np.pi / thing.symmetry
        angle = np.mod(thing.frame.angle - truth.angle + turn / 2, turn) - turn / 2
        errors = np.array([*(thing.frame.position - truth.position), angle])
        yield Result(row, errors, float(errors @ np.linalg.solve(thing.covariance, errors)), seconds)


def print_calibrations(pool: ProcessPoolExecutor, seeds: Sequence[int]) -> None:
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


def marker_for(model: ObjectModel, number: int) -> Marker:
    """The marker that fits on an object, with a white margin of a sixth of the ink."""
    return Marker(model.name, number, float(np.ptp(model.outline, axis=0).min()) * 0.75, model.z)


def with_markers(
    picture: Picture, camera: Camera, markers: Sequence[Marker], frames: Mapping[str, Frame], samples: int
) -> Picture:
    """The picture with markers drawn in it, each pixel the mean of as many points as the renderer takes."""
    result = picture.copy()
    for marker in markers:
        cells = np.pad(marker_image(marker.number), 1, constant_values=255)
        centre = camera.project([*frames[marker.name].position, marker.z])
        reach = 0.8 * marker.size * camera.matrix[0, 0] / (camera.world_from_camera.position[2] - marker.z)
        reach += 20.0  # A distorted lens draws a little larger.
        low = np.maximum(np.floor(centre - reach).astype(int), 0)
        high = np.minimum(np.ceil(centre + reach).astype(int), [camera.width, camera.height])
        columns, rows = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        part = result[low[1] : high[1], low[0] : high[0]]
        colours = [
            _painted(
                part, np.stack([columns, rows], axis=-1) + shift, camera, marker, cells, frames[marker.name]
            )
            for shift in sample_pattern(samples)
        ]
        part[:] = np.rint(np.mean(colours, axis=0))
    return result


def _painted(
    part: Picture, pixels: Array, camera: Camera, marker: Marker, cells: Picture, frame: Frame
) -> Picture:
    """A part of a picture with one marker, sampled at places in the picture, shape (height, width, 2)."""
    local = frame.localise(camera.to_plane(pixels, marker.z)) / (marker.size / 6)
    column, row = np.floor(local[..., 0] + 4).astype(int), np.floor(4 - local[..., 1]).astype(int)
    on_marker = (column >= 0) & (column < 8) & (row >= 0) & (row < 8)
    ink = np.where(cells[np.clip(row, 0, 7), np.clip(column, 0, 7)] > 0, BRIGHT, DARK)
    return np.where(on_marker[..., None], ink[..., None], part).astype(np.uint8)


def varied_light(generator: np.random.Generator) -> Light:
    """A lamp somewhere above, of another colour and strength every time."""
    x, y = generator.uniform(-0.8, 0.8, size=2)
    ambient = generator.uniform(0.35, 0.7)
    return Light(
        direction=(x, y, 1.0),
        colour=tuple(generator.uniform(0.8, 1.0, size=3)),
        ambient=ambient,
        diffuse=generator.uniform(0.2, 0.95 - ambient),
        specular=generator.uniform(0.0, 0.05),
    )


def spoiler(
    condition: Condition,
    camera: Camera,
    models: Sequence[ObjectModel],
    frames: Mapping[str, Frame],
    generator: np.random.Generator,
) -> Callable[[Picture], Picture]:
    """What a condition does to a picture once it is drawn; the same to every picture that it is given."""
    lens = Lens(blur=generator.uniform(0.0, 1.5)) if condition.vary_sensor else Lens()
    sensor = varied_sensor(generator) if condition.vary_sensor else Sensor()
    cover = np.zeros((camera.height, camera.width), dtype=bool)
    if condition.covered > 0.0:
        for model in models:
            cover |= cover_mask(camera, model, frames[model.name], condition.covered, generator)
    grey, seed = generator.integers(60, 200), int(generator.integers(2**31))
    straight = replace(camera, distortion=np.zeros(5))  # The picture is bent already.

    def spoil(picture: Picture) -> Picture:
        covered = np.where(cover[..., None], grey, picture).astype(np.uint8)
        if not condition.vary_sensor:
            return covered
        return on_sensor(through_lens(covered, straight, straight, lens), sensor, np.random.default_rng(seed))

    return spoil


def varied_sensor(generator: np.random.Generator) -> Sensor:
    """Noise, exposure and colour cast, others every time."""
    return Sensor(
        exposure=generator.uniform(0.5, 1.2),
        colour_cast=tuple(generator.uniform(0.85, 1.15, size=3)),
        noise=generator.uniform(1.0, 8.0),
    )


def cover_mask(
    camera: Camera, model: ObjectModel, frame: Frame, share: float, generator: np.random.Generator
) -> NDArray[np.bool_]:
    """Where something with a straight edge covers a share of an object from a random side, shape (h, w)."""
    direction = generator.uniform(0.0, 2 * np.pi)
    hull = silhouette_hull(model, frame, camera)
    v, u = np.indices((camera.height, camera.width))
    pixels = np.stack([u, v], axis=-1)
    along = pixels @ np.array([np.cos(direction), np.sin(direction)])
    inside = Polygon(hull).contains_points(pixels.reshape(-1, 2)).reshape(along.shape)
    centre = hull.mean(axis=0)
    near = np.linalg.norm(pixels - centre, axis=-1) < 1.3 * np.linalg.norm(hull - centre, axis=1).max()
    return np.asarray(near & (along > np.quantile(along[inside], 1.0 - share)))


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
