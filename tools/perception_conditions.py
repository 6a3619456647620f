"""What the pictures of a perception benchmark are like: scenes, light, lens, sensor and covers."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame
from perception.picture import Picture
from perception.silhouette import silhouette_hull
from scenes import Renderer, SceneDescription, load_scene
from scenes.imperfections import on_sensor, through_lens
from scenes.view import Lens, Light, Sensor

DISTORTION = (-0.25, 0.08, 0.001, -0.002, 0.0)

PRINTED = {
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
        covered: Share of each object that something grey covers from one side, and nothing else of it.
        colours: Of cube and container, where they are not red and blue.
        orb: Whether the printed boxes are looked for by ORB, too.
    """

    renderer: Renderer = "tiny"
    samples: int = 1
    vary_light: bool = False
    vary_sensor: bool = False
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    covered: float = 0.0
    colours: Mapping[str, str] = field(default_factory=dict)
    orb: bool = False


CONDITIONS = {
    "clean": Condition(orb=True),
    "clean, EGL": Condition(renderer="egl"),
    "clean, 4 samples a pixel": Condition(samples=4),
    "noise, blur, exposure, cast, light varied": Condition(vary_light=True, vary_sensor=True, orb=True),
    "the same, EGL": Condition(renderer="egl", vary_light=True, vary_sensor=True),
    "30 % covered": Condition(covered=0.3),
    "distorted lens": Condition(distortion=DISTORTION),
    "white cube, grey container, light varied": Condition(
        vary_light=True, colours={"cube": "white", "container": "grey"}
    ),
}


def scene_of(condition: Condition) -> SceneDescription:
    """The scene, with printed boxes, under a condition."""
    content: dict[str, Any] = load_scene("pick_and_place").model_dump()
    place = {"x": (0.37, 0.63), "y": (-0.29, 0.29), "angle_deg": (-180.0, 180.0)}
    for name, (size, print_) in PRINTED.items():
        printed = {"size": size, "print": print_, "colour": "white", "place": place}
        content["objects"][name] = content["objects"]["cube"] | printed
    for name in ("cube", "container"):
        content["objects"][name]["place"] = place
    for name, colour in condition.colours.items():
        content["objects"][name]["colour"] = colour
    content["camera"] |= {"samples": condition.samples, "lens": {"distortion": condition.distortion}}
    return SceneDescription.model_validate(content | {"centre_distance": 0.15})


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
        images = [image_of(model, frames[model.name], camera) for model in models]
        for i, image in enumerate(images):
            others = np.any(images[:i] + images[i + 1 :], axis=0)
            cover |= cover_mask(image, condition.covered, generator) & ~others
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


def image_of(model: ObjectModel, frame: Frame, camera: Camera) -> NDArray[np.bool_]:
    """Where an object is in the picture, its convex hull, shape (height, width)."""
    mask = np.zeros((camera.height, camera.width), np.uint8)
    cv2.fillConvexPoly(mask, np.rint(silhouette_hull(model, frame, camera)).astype(np.int32), 1)
    return mask > 0


def cover_mask(image: NDArray[np.bool_], share: float, generator: np.random.Generator) -> NDArray[np.bool_]:
    """Where something with a straight edge covers a share of an object from a random side, shape (h, w)."""
    direction = generator.uniform(0.0, 2 * np.pi)
    rows, columns = np.indices(image.shape)
    along = columns * np.cos(direction) + rows * np.sin(direction)
    v, u = np.nonzero(image)
    reach = 1.3 * np.hypot(u - u.mean(), v - v.mean()).max()
    near = np.hypot(columns - u.mean(), rows - v.mean()) < reach
    return np.asarray(near & (along > np.quantile(along[image], 1.0 - share)))
