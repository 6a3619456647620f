"""How a scene is seen: its camera and its light."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field, ValidatorFunctionWrapHandler, field_validator, model_validator

from cobot_lfd.camera import Camera
from cobot_lfd.camera_file import CameraValues, load_camera
from cobot_lfd.description_file import DescriptionModel
from scenes.quantities import Positive, Share, Vector
from scenes.shapes import ColourValue


class Lens(DescriptionModel):
    """What the lens does to the picture; as it is here by default, nothing.

    Attributes:
        distortion: The coefficients k1, k2, p1, p2, k3 of ``cobot_lfd.lens``.
        blur: Standard deviation of the spot that it makes of a point [px].
    """

    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    blur: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0


class Sensor(DescriptionModel):
    """What the sensor does to the picture; as it is here by default, nothing.

    Attributes:
        exposure: Factor of all brightness; what becomes too bright is cut.
        colour_cast: Factors of red, green and blue.
        noise: Standard deviation of the noise of each colour of each pixel, of 255.
    """

    exposure: Positive = 1.0
    colour_cast: tuple[Positive, Positive, Positive] = (1.0, 1.0, 1.0)
    noise: Annotated[float, Field(ge=0.0, le=255.0)] = 0.0


class CameraDescription(DescriptionModel):
    """A camera.

    Attributes:
        position: The camera's centre in the world [m].
        target: The point in the middle of the picture [m].
        up: Direction in the world that points up in the picture.
        field_of_view_deg: Vertical opening angle [degrees].
        width: Picture width [px].
        height: Picture height [px].
        lens: What the lens does to the picture.
        sensor: What the sensor does to the picture.
        samples: Points of a pixel that are averaged, a picture each; 1 leaves the edges jagged.
        calibration: A camera's file as ``cobot-lfd calibrate`` writes it, or what it holds. Pictures are then
            read as that camera's: where this one really stands, and what its lens does, only the renderer
            knows.
    """

    position: Vector
    target: Vector
    up: Vector
    field_of_view_deg: Annotated[float, Field(gt=0.0, lt=180.0)]
    width: Annotated[int, Field(ge=16, le=4096)] = 640
    height: Annotated[int, Field(ge=16, le=4096)] = 480
    lens: Lens = Lens()
    sensor: Sensor = Sensor()
    samples: Annotated[int, Field(ge=1, le=16)] = 1
    calibration: Path | CameraValues | None = None

    @field_validator("calibration", mode="wrap")
    @classmethod
    def _calibration_is_a_file(
        cls, value: object, check: ValidatorFunctionWrapHandler
    ) -> Path | CameraValues | None:
        if not isinstance(value, str | Path | CameraValues | dict | None):
            told = f"must be the name of a camera's file; given: {value!r}."
            raise ValueError(told)  # noqa: TRY004 - pydantic tells users of this kind only
        found: Path | CameraValues | None = check(value)
        return found

    @model_validator(mode="after")
    def _looks_somewhere(self) -> "CameraDescription":
        forward = np.subtract(self.target, self.position)
        if not np.linalg.norm(np.cross(forward, self.up)) > 1e-9:
            raise ValueError("up must not be parallel to the line from position to target.")
        return self

    @model_validator(mode="after")
    def _calibration_is_of_such_a_camera(self) -> "CameraDescription":
        if self.calibration is not None:
            known = self.camera
            if (known.width, known.height) != (self.width, self.height):
                name = self.calibration if isinstance(self.calibration, Path) else "it"
                raise ValueError(
                    f"calibration: {name} is of a camera of {known.width} x {known.height} px, "
                    f"but this one takes {self.width} x {self.height} px; calibrate it: cobot-lfd calibrate."
                )
        return self

    @property
    def camera(self) -> Camera:
        """The camera as far as it is known: calibrated, or as it is described. Pictures are read by it."""
        if self.calibration is None:
            return self.true_camera
        return (
            load_camera(self.calibration) if isinstance(self.calibration, Path) else self.calibration.camera
        )

    @property
    def true_camera(self) -> Camera:
        """The camera as it is. Only for the renderer, and for judging a calibration."""
        ideal = Camera.looking_at(
            self.position,
            self.target,
            up=self.up,
            field_of_view=np.deg2rad(self.field_of_view_deg),
            width=self.width,
            height=self.height,
        )
        return replace(ideal, distortion=np.array(self.lens.distortion))


class Light(DescriptionModel):
    """One lamp and the light that comes from everywhere.

    Attributes:
        direction: From the scene to the lamp.
        distance: Of the lamp from the world's origin [m].
        colour: Of the lamp.
        ambient: Share of light that comes from everywhere.
        diffuse: Share of light that is scattered evenly.
        specular: Share of light that is mirrored.
        shadow: Whether objects throw shadows.
    """

    direction: Vector = (0.0, 0.0, 1.0)
    distance: Positive = 2.0
    colour: ColourValue = (1.0, 1.0, 1.0)
    ambient: Share = 0.6
    diffuse: Share = 0.35
    specular: Share = 0.05
    shadow: bool = True

    @model_validator(mode="after")
    def _comes_from_above(self) -> "Light":
        if self.direction[2] <= 0.0:
            raise ValueError(
                f"direction has z = {self.direction[2]}; the lamp must be above the table (z > 0)."
            )
        return self
