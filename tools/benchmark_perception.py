"""How precisely objects are found, in good and bad conditions, beside ArUco markers at the same poses.

Every row is one object or marker in one condition. The pictures are those of a scene, its objects put at
random places that its file allows; each marker is drawn where an object stands, as large as there is room
for. Errors are against the simulator's poses; times are of one core.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from time import process_time

import numpy as np
import tyro
from matplotlib.path import Path as Polygon
from numpy.typing import NDArray

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from cobot_lfd.marker import Marker, marker_image
from perception import Detector, MarkerDetector, ShapeDetector
from perception.picture import Picture
from perception.silhouette import silhouette_hull
from scenes import CameraDescription, World, load_scene, object_models
from scenes.imperfections import on_sensor, through_lens
from scenes.placement import draw_placements
from scenes.rendering import Renderer, sample_pattern
from scenes.view import Lens, Light, Sensor

WRONG_MM = 10.0  # What is this far from the truth is another thing [mm].
DARK, BRIGHT = 25, 230  # A marker's ink and paper, of 255.
DISTORTION = (-0.25, 0.08, 0.001, -0.002, 0.0)


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
    """

    renderer: Renderer = "tiny"
    samples: int = 1
    vary_light: bool = False
    vary_sensor: bool = False
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    covered: float = 0.0


CONDITIONS = {
    "clean": Condition(),
    "clean, 4 samples a pixel": Condition(samples=4),
    "clean, EGL": Condition(renderer="egl"),
    "light varied": Condition(vary_light=True),
    "light varied, EGL": Condition(renderer="egl", vary_light=True),
    "noise, blur, exposure, cast, light varied": Condition(vary_light=True, vary_sensor=True),
    "distorted lens": Condition(distortion=DISTORTION),
    "30 % covered": Condition(covered=0.3),
}


@dataclass(frozen=True, slots=True)
class Result:
    """One object in one picture.

    Attributes:
        method: "outline" or "marker".
        name: Name of the object.
        errors: In x [m], y [m] and angle [rad], shape (3,); None if it was not found.
        normalised: Errors squared, by the covariance that was given with them; 3 on average if that is right.
        seconds: Time that it took to find all objects of the picture [s].
    """

    method: str
    name: str
    errors: Array | None
    normalised: float
    seconds: float


def main(
    scene: str = "pick_and_place", pictures: int = 500, seed: int = 0, only: tuple[str, ...] = ()
) -> None:
    """Print the table.

    Args:
        scene: Name of the scene.
        pictures: Number of pictures per condition.
        seed: Decides where the objects stand and how the conditions vary.
        only: Conditions to be measured; all of them if empty.
    """
    head = ["condition", "found as", "n", "found", "wrong", "mm median", "mm 99 %", "° median", "° 99 %"]
    print("| " + " | ".join([*head, "error² / 3σ²", "ms a picture"]) + " |")
    print("| --- | --- |" + " ---: |" * 9)
    for name, condition in CONDITIONS.items():
        if not only or name in only:
            results = list(measure(scene, condition, pictures, seed))
            for method, thing in dict.fromkeys((r.method, r.name) for r in results):
                chosen = [r for r in results if (r.method, r.name) == (method, thing)]
                print(f"| {name} | {thing}, {method} | {as_text(chosen)} |", flush=True)


def as_text(results: Sequence[Result]) -> str:
    """The numbers of a row of the table."""
    errors = np.array([r.errors for r in results if r.errors is not None]).reshape(-1, 3)
    if not len(errors):
        return f"{len(results)} | 0.0% | 0 |" + " |" * 5 + " "
    mm, degrees = 1e3 * np.linalg.norm(errors[:, :2], axis=1), np.rad2deg(np.abs(errors[:, 2]))
    normalised = np.mean([r.normalised for r in results if r.errors is not None]) / 3
    numbers = [*np.percentile(mm, [50, 99]), *np.percentile(degrees, [50, 99]), normalised]
    cells = [f"{len(results)}", f"{len(mm) / len(results):.1%}", f"{np.sum(mm > WRONG_MM)}"]
    cells += [f"{number:.2f}" for number in numbers]
    return " | ".join([*cells, f"{1e3 * np.median([r.seconds for r in results]):.1f}"])


def measure(scene: str, condition: Condition, n: int, seed: int) -> Iterator[Result]:
    """Find everything in the pictures of one condition, by its outline and by a marker in its place."""
    description, generator = load_scene(scene), np.random.default_rng(seed)
    models = object_models(description)
    markers = tuple(marker_for(model, number) for number, model in enumerate(models))
    seen = CameraDescription.model_validate(
        description.camera.model_dump()
        | {"samples": condition.samples, "lens": {"distortion": condition.distortion}}
    )
    camera = seen.camera
    with World(description, seed, renderer=condition.renderer) as world:
        for _ in range(n):
            frames = draw_placements(description, generator)
            for name, frame in frames.items():
                world.place(name, frame)
            light = varied_light(generator) if condition.vary_light else None
            plain = world.take_picture(camera=seen, light=light)
            marked = with_markers(plain, camera, markers, frames, condition.samples)
            spoil = spoiler(condition, camera, models, frames, generator)
            yield from find("outline", ShapeDetector(models), spoil(plain), camera, frames)
            yield from find("marker", MarkerDetector(markers), spoil(marked), camera, frames)


def find(
    method: str,
    detector: Detector,
    picture: Picture,
    camera: Camera,
    frames: Mapping[str, Frame],
) -> Iterator[Result]:
    """Run a detector on a picture and compare what it finds with the truth."""
    began = process_time()
    found = detector.detect(picture, camera)
    seconds = process_time() - began
    for thing in found:
        if isinstance(thing, NotSeen):
            yield Result(method, thing.name, None, np.nan, seconds)
            continue
        truth, turn = frames[thing.name], 2 * np.pi / thing.symmetry
        angle = np.mod(thing.frame.angle - truth.angle + turn / 2, turn) - turn / 2
        errors = np.array([*(thing.frame.position - truth.position), angle])
        yield Result(
            method, thing.name, errors, float(errors @ np.linalg.solve(thing.covariance, errors)), seconds
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
    tyro.cli(main)
