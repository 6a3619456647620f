"""What will be run: every scene, robot, contender, perturbation and seed, known before the first."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from cobot_lfd.app.evaluation.contender import Contender
from cobot_lfd.app.evaluation.perturbation import Perturbation
from cobot_lfd.camera_file import read_camera_values
from cobot_lfd.errors import DataError
from robots import load_robot
from scenes import SceneDescription, load_scene

FORMAT, VERSION = "cobot_lfd evaluation plan", 1


@dataclass(frozen=True, slots=True)
class Trial:
    """One episode of a plan; complete in itself, so that it can be sent to another machine.

    Attributes:
        number: Its place in the plan, from 0.
        run: Identifies the plan.
        seed: Seed of the episode.
        scene: Name of the scene.
        robot: Name of the robot.
        perturbation: What is made harder.
        contender: What is evaluated.
    """

    number: int
    run: str
    seed: int
    scene: str
    robot: str
    perturbation: Perturbation
    contender: Contender


@dataclass(frozen=True, slots=True)
class Plan:
    """The axes of an evaluation; its trials are their cross product.

    Attributes:
        scenes: Names of the scenes.
        robots: Names of the robots.
        contenders: What is compared.
        perturbations: What is made harder.
        seeds: Seeds of the episodes; all else is tried on the same seeds.
        fingerprints: Checksums of the scenes' and robots' descriptions by name.
    """

    scenes: tuple[str, ...]
    robots: tuple[str, ...]
    contenders: tuple[Contender, ...]
    perturbations: tuple[Perturbation, ...]
    seeds: range
    fingerprints: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        *,
        scenes: tuple[str, ...],
        robots: tuple[str, ...],
        contenders: tuple[Contender, ...],
        perturbations: tuple[Perturbation, ...],
        seeds: range,
    ) -> "Plan":
        """A plan, after a look at the descriptions of its scenes and robots.

        Raises:
            DescriptionError: If there is no such scene or robot.
            DataError: If two contenders have the same name, or an axis is empty.
        """
        plan = cls(scenes, robots, contenders, perturbations, seeds, fingerprints(scenes, robots))
        labels = [contender.label for contender in contenders]
        for label in labels:
            if labels.count(label) > 1:
                raise DataError(f"two models are called '{label}'; rename the file of one.")
        if not len(plan):
            raise DataError("there is nothing to evaluate: give scenes, robots, and models or methods.")
        return plan

    def __len__(self) -> int:
        """Number of trials."""
        axes = (self.scenes, self.robots, self.contenders, self.perturbations, self.seeds)
        count = 1
        for axis in axes:
            count *= len(axis)
        return count

    @property
    def run(self) -> str:
        """Identifies the plan: equal where all that decides its results is equal."""
        content = json.dumps(self._content(), sort_keys=True, ensure_ascii=False)
        return hashlib.sha256(content.encode()).hexdigest()[:16]

    def trials(self) -> Iterator[Trial]:
        """All trials; the seed varies slowest, so that a run stopped early is still a fair comparison."""
        run = self.run
        axes = product(self.seeds, self.scenes, self.robots, self.perturbations, self.contenders)
        for number, (seed, scene, robot, perturbation, contender) in enumerate(axes):
            yield Trial(number, run, seed, scene, robot, perturbation, contender)

    def trial(self, number: int) -> Trial:
        """The trial with a number.

        Raises:
            DataError: If the plan has no such trial.
        """
        for trial in self.trials():
            if trial.number == number:
                return trial
        raise DataError(f"there is no trial {number}; this plan has 0 to {len(self) - 1}.")

    def to_json(self) -> str:
        """The plan as text; the contenders' contents are left out and named by their checksums."""
        content = {"format": FORMAT, "version": VERSION, "run": self.run, "trials": len(self)}
        return json.dumps(content | self._content(), indent=2, ensure_ascii=False)

    @classmethod
    def from_json(cls, text: str, contents: Mapping[str, bytes]) -> "Plan":
        """Read a plan back.

        Args:
            text: What ``to_json`` gave.
            contents: The contenders' contents by checksum.

        Raises:
            DataError: If the text is no plan, or a content is missing.
        """
        try:
            values: dict[str, Any] = json.loads(text)
            _require_version(values["format"], values["version"])
            contenders = tuple(
                Contender(c["label"], c["method"], contents[c["sha256"]]) for c in values["contenders"]
            )
            return cls(
                tuple(values["scenes"]),
                tuple(values["robots"]),
                contenders,
                tuple(Perturbation.model_validate(p) for p in values["perturbations"]),
                range(values["first_seed"], values["first_seed"] + values["episodes"]),
                values["descriptions_sha256"],
            )
        except (ValueError, KeyError, TypeError, ValidationError) as error:
            raise DataError(f"the plan cannot be read: {error!r}.") from error

    def _content(self) -> dict[str, Any]:
        return {
            "scenes": list(self.scenes),
            "robots": list(self.robots),
            "contenders": [
                {"label": c.label, "method": c.method, "sha256": c.sha256} for c in self.contenders
            ],
            "perturbations": [perturbation.changes() for perturbation in self.perturbations],
            "first_seed": self.seeds.start,
            "episodes": len(self.seeds),
            "descriptions_sha256": dict(self.fingerprints),
        }


def _require_version(form: str, version: int) -> None:
    if (form, version) != (FORMAT, VERSION):
        raise ValueError(f"it has format {form!r}, version {version!r}")


def fingerprints(scenes: tuple[str, ...], robots: tuple[str, ...]) -> dict[str, str]:
    """Checksums of descriptions by name, so that a change of a file between two runs is noticed.

    Raises:
        DescriptionError: If there is no such scene or robot.
    """
    described = {f"scene {name}": _in_full(load_scene(name)) for name in scenes}
    described |= {f"robot {name}": load_robot(name).model_dump_json() for name in robots}
    return {name: hashlib.sha256(text.encode()).hexdigest() for name, text in described.items()}


def _in_full(scene: SceneDescription) -> str:
    """A scene's description, with what the file of its camera holds."""
    calibration = scene.camera.calibration
    held = read_camera_values(calibration).model_dump_json() if isinstance(calibration, Path) else ""
    return scene.model_dump_json() + held
