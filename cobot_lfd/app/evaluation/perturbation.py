"""What differs from the scene's own file and the arm's usual manner: noise, light, ranges, compliance, ..."""

import hashlib
from dataclasses import replace
from itertools import product
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from cobot_lfd.app.perceive import View
from cobot_lfd.camera_file import CameraValues
from cobot_lfd.description_file import DescriptionModel
from cobot_lfd.detection import Detection
from cobot_lfd.frame import Frame
from cobot_lfd.motion import TimingMethod
from scenes import SceneDescription

_DETECTION_STREAM = 2  # keeps this noise apart from the scene's layout, which has the same seed

_NotNegative = Annotated[float, Field(ge=0.0, le=1000.0)]
_Factor = Annotated[float, Field(gt=0.0, le=10.0)]


class Perturbation(DescriptionModel):
    """One way of making an episode harder, or of performing it in another manner; by default none.

    Attributes:
        detection_noise_mm: Standard deviation added to each coordinate of what was seen [mm].
        detection_noise_deg: Standard deviation added to the angle of what was seen [degrees].
        camera_noise: Standard deviation of the camera's noise in each colour of each pixel, of 255.
        camera_blur: Standard deviation of the spot that the lens makes of a point [px].
        light: Factor of the lamp's brightness.
        light_turn_deg: Turn of the lamp about the vertical [degrees].
        distractors: How many things stand about that the detector does not know.
        friction: Factor of all objects' friction.
        range: Factor by which the ranges of the objects' places grow about their middles.
        demonstrations: How many of the demonstrations are learnt from; 0 stands for all.
        compliant: Whether the arm gives way during the carry where the demonstrations strayed.
        timing: How the motion along the path gets its times.
        covered: Whether something covers the camera's lens.
        camera: The calibrated camera by which pictures are read; None: the scene's.
    """

    detection_noise_mm: _NotNegative = 0.0
    detection_noise_deg: _NotNegative = 0.0
    camera_noise: Annotated[float, Field(ge=0.0, le=255.0)] = 0.0
    camera_blur: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    light: _Factor = 1.0
    light_turn_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 0.0
    distractors: Annotated[int, Field(ge=0, le=20)] = 0
    friction: _Factor = 1.0
    range: _Factor = 1.0
    demonstrations: Annotated[int, Field(ge=0)] = 0
    compliant: bool = False
    timing: TimingMethod = "simple"
    covered: bool = False
    camera: CameraValues | None = None

    def changes(self) -> dict[str, Any]:
        """What differs from no perturbation, by name; ``model_validate`` reads it back."""
        values = self.model_dump(mode="json")
        return {name: value for name, value in values.items() if value != getattr(_NOTHING, name)}

    def told(self) -> dict[str, float | str]:
        """The same for people, who know a camera by its checksum."""
        known = {} if self.camera is None else {"camera": _checksum(self.camera)}
        return self.changes() | known

    @property
    def label(self) -> str:
        """What differs, in words; "none" where nothing does."""
        return ", ".join(f"{name} {_word(value)}" for name, value in self.told().items()) or "none"

    def of_scene(self, scene: SceneDescription) -> SceneDescription:
        """The scene as it is under this perturbation."""
        content = scene.model_dump()
        _dim_and_turn(content["light"], self.light, np.deg2rad(self.light_turn_deg))
        content["camera"]["sensor"]["noise"] += self.camera_noise
        content["camera"]["lens"]["blur"] += self.camera_blur
        if self.camera is not None:
            content["camera"]["calibration"] = self.camera
        content["distractors"] += self.distractors
        content["table"]["friction"] *= self.friction
        for item in content["objects"].values():
            item["friction"] = min(5.0, item["friction"] * self.friction)
            item["place"] |= {axis: _widened(item["place"][axis], self.range) for axis in "xy"}
        return SceneDescription.model_validate(content)

    def of_view(self, view: View, seed: int) -> View:
        """What is believed to have been seen under this perturbation."""
        if not (self.detection_noise_mm or self.detection_noise_deg):
            return view
        rng = np.random.default_rng([seed, _DETECTION_STREAM])
        return replace(
            view,
            detections=tuple(self._misjudged(item, rng) for item in view.detections),
            learnt=tuple(
                self._misjudged(item, rng) if isinstance(item, Detection) else item for item in view.learnt
            ),
            others=tuple(self._misjudged(item, rng) for item in view.others),
        )

    def _misjudged(self, seen: Detection, rng: np.random.Generator) -> Detection:
        shift = rng.normal(size=2) * self.detection_noise_mm / 1e3
        turn = rng.normal() * np.deg2rad(self.detection_noise_deg)
        added = np.diag([self.detection_noise_mm / 1e3] * 2 + [np.deg2rad(self.detection_noise_deg)]) ** 2
        return Detection(
            name=seen.name,
            frame=Frame(seen.frame.position + shift, seen.frame.angle + float(turn)),
            symmetry=seen.symmetry,
            covariance=seen.covariance + added,
            confidence=seen.confidence,
            contour=seen.contour,
        )


class Sweep(DescriptionModel):
    """Values to try of each perturbation; all combinations of them are evaluated.

    Attributes:
        detection_noise_mm: Noise of what was seen, of each coordinate [mm].
        detection_noise_deg: Noise of what was seen, of the angle [degrees].
        camera_noise: Noise of the camera's pixels, of 255.
        camera_blur: Blur of the lens [px].
        light: Factors of the lamp's brightness.
        light_turn_deg: Turns of the lamp about the vertical [degrees].
        distractors: Numbers of things that stand about and that the detector does not know.
        friction: Factors of all objects' friction.
        range: Factors by which the ranges of the objects' places grow; beyond 1 is beyond what was shown.
        demonstrations: How many of the demonstrations are learnt from; 0 stands for all.
        compliant: Whether the arm gives way during the carry where the demonstrations strayed.
        timing: How the motion along the path gets its times.
    """

    detection_noise_mm: tuple[float, ...] = (0.0,)
    detection_noise_deg: tuple[float, ...] = (0.0,)
    camera_noise: tuple[float, ...] = (0.0,)
    camera_blur: tuple[float, ...] = (0.0,)
    light: tuple[float, ...] = (1.0,)
    light_turn_deg: tuple[float, ...] = (0.0,)
    distractors: tuple[int, ...] = (0,)
    friction: tuple[float, ...] = (1.0,)
    range: tuple[float, ...] = (1.0,)
    demonstrations: tuple[int, ...] = (0,)
    compliant: tuple[bool, ...] = (False,)
    timing: tuple[TimingMethod, ...] = ("simple",)

    def perturbations(
        self, *, covered: bool = False, camera: CameraValues | None = None
    ) -> tuple[Perturbation, ...]:
        """Every combination, the first option varying slowest.

        Args:
            covered: Whether something covers the camera's lens in all of them.
            camera: The calibrated camera by which pictures are read in all of them; None: the scene's.

        Raises:
            ValidationError: If a value is not allowed; it is a ``ValueError``.
        """
        axes, always = self.model_dump(), {"covered": covered, "camera": camera}
        return tuple(
            Perturbation.model_validate(dict(zip(axes, values, strict=True)) | always)
            for values in product(*axes.values())
        )


_NOTHING = Perturbation()


def _checksum(camera: CameraValues) -> str:
    return hashlib.sha256(camera.model_dump_json().encode()).hexdigest()[:8]


def _word(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def _dim_and_turn(light: dict[str, Any], factor: float, turn: float) -> None:
    for part in ("ambient", "diffuse", "specular"):
        light[part] = min(1.0, light[part] * factor)
    x, y, z = light["direction"]
    cos, sin = float(np.cos(turn)), float(np.sin(turn))
    light["direction"] = (cos * x - sin * y, sin * x + cos * y, z)


def _widened(limits: tuple[float, float], factor: float) -> tuple[float, float]:
    middle, half = 0.5 * (limits[0] + limits[1]), 0.5 * factor * (limits[1] - limits[0])
    return middle - half, middle + half
