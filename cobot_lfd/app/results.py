"""The result of one episode: what happened, in one line of JSON that two runs share to the last bit."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame
from cobot_lfd.outcome import Outcome, Verdict


@dataclass(frozen=True, slots=True, kw_only=True)
class SeenObject:
    """Where perception saw an object, and how far from the truth.

    Attributes:
        name: Name of the object.
        x: Position that was seen, along the world's x axis [m].
        y: Position that was seen, along the world's y axis [m].
        angle: Direction that was seen [rad].
        symmetry: Number of turns within a full circle that look the same.
        position_error: Distance to the true position [m].
        angle_error: Angle to the nearest true direction that looks the same [rad], in 0..pi / symmetry.
    """

    name: str
    x: float
    y: float
    angle: float
    symmetry: int
    position_error: float
    angle_error: float

    @classmethod
    def of(cls, detection: Detection, true_frame: Frame) -> "SeenObject":
        """Compare what was seen with the truth, which only the judge of an episode knows."""
        x, y = detection.frame.position.tolist()
        return cls(
            name=detection.name,
            x=x,
            y=y,
            angle=detection.frame.angle,
            symmetry=detection.symmetry,
            position_error=float(np.linalg.norm(detection.frame.position - true_frame.position)),
            angle_error=symmetric_angle_error(detection.frame.angle, true_frame.angle, detection.symmetry),
        )


def symmetric_angle_error(angle: float, true_angle: float, symmetry: int) -> float:
    """Angle to the nearest true direction that looks the same [rad], in 0..pi / symmetry."""
    turn = 2 * np.pi / symmetry
    difference = (angle - true_angle) % turn
    return float(min(difference, turn - difference))


@dataclass(frozen=True, slots=True, kw_only=True)
class EpisodeResult:
    """What happened in one episode of an evaluation.

    Attributes:
        seed: Seed of the episode.
        scene: Name of the scene.
        robot: Name of the robot.
        method: Name of the learning method, such as "improved".
        contender: Name of what was evaluated, where several were: a model's file or a method.
        perturbation: What differs from the scene's file and the arm's usual manner, by name; empty: nothing.
        run: Identifies the plan that the episode belongs to; empty for a single episode.
        trial: Place of the episode in that plan.
        verdict: How the episode ended.
        objects: What was seen and how well, in the order of detection.
        duration: Duration of the arm's whole motion [s]; None where no motion was planned.
        metrics: Figures of the generated path by name ("length" [m], ...); empty where there was no path.
        times: Time that the program needed for each stage, by name [s]; the only part that differs between
            two runs of the same episode.
    """

    seed: int
    scene: str
    robot: str
    method: str
    verdict: Verdict
    contender: str = ""
    perturbation: Mapping[str, float | str] = field(default_factory=dict)
    run: str = ""
    trial: int = 0
    objects: tuple[SeenObject, ...] = ()
    duration: float | None = None
    metrics: Mapping[str, float] = field(default_factory=dict)
    times: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Copy; plain dictionaries, because results travel between processes."""
        object.__setattr__(self, "objects", tuple(self.objects))
        object.__setattr__(self, "perturbation", dict(self.perturbation))
        object.__setattr__(self, "metrics", dict(self.metrics))
        object.__setattr__(self, "times", dict(self.times))

    def to_json(self) -> str:
        """One line without its end; equal episodes give equal lines once "times" is left out."""
        return _line({**self._comparable(), "times": dict(self.times)})

    def comparable_json(self) -> str:
        """The line without "times": two runs of the same episode give the same."""
        return _line(self._comparable())

    def _comparable(self) -> dict[str, Any]:
        return {
            "run": self.run,
            "trial": self.trial,
            "seed": self.seed,
            "scene": self.scene,
            "robot": self.robot,
            "method": self.method,
            "contender": self.contender,
            "perturbation": dict(self.perturbation),
            "success": self.verdict.succeeded,
            "outcome": self.verdict.outcome.kind,
            "detail": self.verdict.detail,
            "sentence": self.verdict.sentence,
            "objects": [asdict(seen) for seen in self.objects],
            "duration": self.duration,
            "metrics": dict(self.metrics),
        }

    @classmethod
    def from_json(cls, line: str) -> "EpisodeResult":
        """Read a line back.

        Raises:
            DataError: If the line is no result.
        """
        try:
            values = json.loads(line)
            return cls(
                verdict=Verdict(Outcome.from_kind(values["outcome"]), values["detail"]),
                objects=tuple(SeenObject(**seen) for seen in values["objects"]),
                **{name: values[name] for name in _PLAIN},
            )
        except (ValueError, KeyError, TypeError) as error:
            raise DataError(f"{line[:60]!r} is no result of an episode: {error!r}.") from error


_PLAIN = (
    *("run", "trial", "seed", "scene", "robot", "method"),
    *("contender", "perturbation", "duration", "metrics", "times"),
)


def _line(values: dict[str, Any]) -> str:
    return json.dumps(values, ensure_ascii=False, allow_nan=False)
