"""A scene as its file describes it: read, checked, and told what is wrong where it is wrong."""

from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, model_validator

from cobot_lfd.description_file import DescriptionModel, read_description
from cobot_lfd.errors import DescriptionError
from cobot_lfd.frame import Frame
from scenes.quantities import NotNegative, Positive, Range
from scenes.shapes import ObjectDescription, Table
from scenes.task import Inside, Task
from scenes.variants import apply_variant, split_variant
from scenes.view import CameraDescription, Light

_FOLDER = Path(__file__).parent


class Physics(DescriptionModel):
    """How the simulation runs.

    Attributes:
        time_step: Length of a simulation step [s].
        gravity: Acceleration downwards [m/s²].
    """

    time_step: Annotated[float, Field(gt=0.0, le=0.02)] = 1 / 500
    gravity: Positive = 9.81


class SceneDescription(DescriptionModel):
    """A scene: what stands on the table, what is to be done, how it is seen.

    Attributes:
        title: What the scene is about, for people.
        centre_distance: Least distance between the origins of two objects [m], so that the gripper has room.
        radius: Least and largest distance of the objects that vary from the robot's base [m].
        physics: How the simulation runs.
        table: The table.
        objects: Name to object.
        distractors: How many more things stand on the table, of which nobody is told.
        camera: The camera.
        light: The light.
        task: What is to be done.
        success: When it counts as done.
    """

    title: str
    centre_distance: NotNegative = 0.0
    radius: Range = (0.0, 10.0)
    physics: Physics = Physics()
    table: Table
    objects: Annotated[Mapping[str, ObjectDescription], Field(min_length=1)]
    distractors: Annotated[int, Field(ge=0, le=20)] = 0
    camera: CameraDescription
    light: Light = Light()
    task: Task
    success: Inside

    @model_validator(mode="after")
    def _names_exist(self) -> "SceneDescription":
        for key, name in self._named_objects():
            if name not in self.objects:
                raise ValueError(
                    f"{key}: no object named '{name}'; choose one of: {', '.join(self.objects)}."
                )
        containers = [name for name, item in self.objects.items() if item.shape == "container"]
        if self.success.container not in containers and self.success.region is None:
            allowed = ", ".join(containers) or "there is none"
            raise ValueError(
                f"success.container: '{self.success.container}' is no container; choose one of: {allowed}, "
                "or say in success.region where in it the object must lie."
            )
        return self

    def _named_objects(self) -> Iterator[tuple[str, str]]:
        yield "task.pick", self.task.pick
        yield "task.place", self.task.place
        yield from ((f"task.waypoints.{i}.frame", w.frame) for i, w in enumerate(self.task.waypoints))
        yield "success.object", self.success.object
        yield "success.container", self.success.container
        rules = {"task.start_yaw": self.task.start_yaw, "task.end_yaw": self.task.end_yaw}
        rules_and_more = {**rules, "success.through": self.success.through}
        yield from ((f"{key}.frame", rule.frame) for key, rule in rules_and_more.items() if rule is not None)

    @property
    def frame_names(self) -> tuple[str, ...]:
        """Names of the objects whose frames are the task's parameters."""
        return tuple(name for name, item in self.objects.items() if item.frame)

    @property
    def known_frames(self) -> dict[str, Frame]:
        """The frames of the objects that the camera does not see, because they stand where they always do."""
        return {name: item.place.middle for name, item in self.objects.items() if not item.seen}


def scene_names() -> tuple[str, ...]:
    """Names of the scenes that come with the package, in alphabetical order."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def load_scene(name_or_path: str | Path, *, calibration: Path | None = None) -> SceneDescription:
    """Read a scene by the name of a packaged scene, or from a file whose name ends in ``.toml``.

    After either a variant may be named: ``sorting@wide``.

    Args:
        name_or_path: The scene.
        calibration: File of the camera by which pictures are read; by default what the scene's file says.

    Raises:
        DescriptionError: If there is no such scene, or its file is not as it should be; the message names
            file, key, value and what is allowed.
    """
    name, variant = split_variant(str(name_or_path))
    prepare = partial(_prepared, variant=variant, calibration=calibration)
    if Path(name).suffix == ".toml":
        return read_description(Path(name), SceneDescription, partial(prepare, folder=Path(name).parent))
    if name not in scene_names():
        raise DescriptionError(f"no scene named '{name}'; choose one of: {', '.join(scene_names())}.")
    return read_description(_FOLDER / f"{name}.toml", SceneDescription, prepare)


def _prepared(
    content: dict[str, Any], *, variant: str | None, calibration: Path | None, folder: Path = _FOLDER
) -> dict[str, Any]:
    """What a scene's file says, with a variant's changes, and with the file of its camera as it is found."""
    values = apply_variant(content, variant)
    camera = values.get("camera")
    if isinstance(camera, dict):
        if isinstance(camera.get("calibration"), str):
            camera["calibration"] = folder / camera["calibration"]
        if calibration is not None:
            camera["calibration"] = calibration
    return values
