"""What a user asks to be evaluated, by options or in a TOML file, and the plan that follows from it."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidationError

from cobot_lfd.app.demonstrations.store import load_demonstrations
from cobot_lfd.app.disk import told
from cobot_lfd.app.evaluation.contender import Contender, learnt
from cobot_lfd.app.evaluation.demonstration_bytes import demonstrations_to_bytes
from cobot_lfd.app.evaluation.perturbation import Perturbation, Sweep
from cobot_lfd.app.evaluation.plan import Plan
from cobot_lfd.camera_file import CameraValues, read_camera_values
from cobot_lfd.description_file import DescriptionModel, read_description
from cobot_lfd.errors import CobotError, DataError
from cobot_lfd.learning.model import TaskParameterisedGMM
from scenes import load_scene


class PlanOptions(DescriptionModel):
    """The axes of an evaluation as a user gives them.

    Attributes:
        models: Files of fitted models.
        scene: Names of scenes.
        robot: Names of robots.
        method: Methods that are fitted to the demonstrations.
        demos: Folder of the demonstrations.
        episodes: How many seeds.
        seed: The first seed.
        covered: Whether something covers the camera's lens.
        camera: File of the calibrated camera by which pictures are read; the scenes' own by default.
        sweep: What is made harder.
    """

    models: tuple[Path, ...] = ()
    scene: tuple[str, ...]
    robot: tuple[str, ...] = ("panda",)
    method: tuple[str, ...] = ()
    demos: Path | None = None
    episodes: Annotated[int, Field(ge=1)] = 100
    seed: Annotated[int, Field(ge=0)] = 0
    covered: bool = False
    camera: Path | None = None
    sweep: Sweep = Sweep()

    @classmethod
    def read(cls, file: Path) -> "PlanOptions":
        """Read a TOML file; relative paths in it count from its folder.

        Raises:
            DescriptionError: If the file cannot be read or holds what is not allowed.
        """
        options = read_description(file, cls)
        paths: dict[str, Any] = {"models": tuple(file.parent / model for model in options.models)}
        paths |= {
            name: file.parent / path
            for name, path in (("demos", options.demos), ("camera", options.camera))
            if path is not None
        }
        return options.model_copy(update=paths)

    def plan(self) -> Plan:
        """The plan, after everything in it has been tried: models are read and methods fitted once.

        Raises:
            CobotError: If a model, a method, a scene, a robot or a value cannot be used.
        """
        perturbations = self._perturbations()
        contenders = (*map(_fitted, self.models), *self._methods())
        for contender in contenders:
            for n in {perturbation.demonstrations for perturbation in perturbations}:
                learnt(contender, n)
        return Plan.of(
            scenes=self.scene,
            robots=self.robot,
            contenders=contenders,
            perturbations=perturbations,
            seeds=range(self.seed, self.seed + self.episodes),
        )

    def _perturbations(self) -> tuple[Perturbation, ...]:
        try:
            return self.sweep.perturbations(covered=self.covered, camera=self._camera())
        except ValidationError as error:
            fault = error.errors()[0]
            option = str(fault["loc"][0]).replace("_", "-")
            raise CobotError(f"--{option} is {fault['input']!r}: {fault['msg'].lower()}.") from error

    def _camera(self) -> CameraValues | None:
        """What the camera's file holds, if it is one that all scenes can be seen by."""
        if self.camera is None:
            return None
        values = read_camera_values(self.camera)
        for scene in self.scene:
            load_scene(scene, calibration=self.camera)
        return values

    def _methods(self) -> tuple[Contender, ...]:
        if not self.method:
            return ()
        if self.demos is None:
            raise DataError("methods learn from demonstrations; say where they are: --demos FOLDER.")
        content = demonstrations_to_bytes(load_demonstrations(self.demos))
        return tuple(Contender(method, method, content) for method in self.method)


def _fitted(file: Path) -> Contender:
    TaskParameterisedGMM.load(file)  # tells what is wrong with it under its own name
    with told(file, "read"):
        return Contender(file.name, None, file.read_bytes())
