"""Small made-up episodes and detections for the tests of recording and evaluation."""

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.pulls import Pulls
from cobot_lfd.app.results import EpisodeResult, SeenObject
from cobot_lfd.detection import Detection
from cobot_lfd.frame import Frame
from cobot_lfd.outcome import Outcome, Verdict


def detection(name: str = "cube", *, x: float = 0.5, y: float = 0.1, angle: float = 0.3) -> Detection:
    """A square seen at a place."""
    return Detection(
        name=name,
        frame=Frame(np.array([x, y]), angle),
        symmetry=4,
        covariance=np.diag([1e-8, 1e-8, 1e-6]),
        confidence=0.97,
        contour=np.array([[10.0, 10.0], [20.0, 10.0], [20.0, 20.0], [10.0, 20.0]]),
    )


def episode(seed: int = 3, outcome: Outcome = Outcome.SUCCESS, detail: str = "") -> RecordedEpisode:
    """An episode of 50 samples with numbers drawn from its seed; samples 10 to 39 are carried."""
    rng = np.random.default_rng(seed)
    n_samples = 50
    return RecordedEpisode(
        scene="pick_and_place",
        robot="panda",
        seed=seed,
        verdict=Verdict(outcome, detail),
        times=np.linspace(0.0, 2.0, n_samples),
        joint_positions=rng.normal(size=(n_samples, 7)),
        joint_velocities=rng.normal(size=(n_samples, 7)),
        joint_torques=rng.normal(size=(n_samples, 7)),
        tool_positions=rng.normal(size=(n_samples, 3)),
        tool_quaternions=np.tile([1.0, 0.0, 0.0, 0.0], (n_samples, 1)),
        gripper_openings=rng.uniform(0.0, 0.08, n_samples),
        gripper_orders=np.where(np.arange(n_samples) < 10, 0.08, 0.0),
        hand_forces=rng.normal(size=(n_samples, 3)),
        hand_torques=rng.normal(size=(n_samples, 3)),
        carrying=(np.arange(n_samples) >= 10) & (np.arange(n_samples) < 40),
        picture=rng.integers(0, 256, (24, 32, 3), dtype=np.uint8),
        detections=(detection("cube"), detection("container", x=0.6, y=-0.2, angle=-0.5)),
        pulls=Pulls(rng.normal(size=(250, 3)), rng.normal(size=(250, 3)), np.zeros(250)),
    )


def seen(position_error: float = 0.0004, angle_error: float = 0.002) -> SeenObject:
    """A cube that was seen with given errors [m], [rad]."""
    return SeenObject(
        name="cube",
        x=0.5,
        y=0.1,
        angle=0.3,
        symmetry=4,
        position_error=position_error,
        angle_error=angle_error,
    )


def result(seed: int = 1000, outcome: Outcome = Outcome.SUCCESS, detail: str = "") -> EpisodeResult:
    """A result with numbers that have no short decimal form."""
    return EpisodeResult(
        seed=seed,
        scene="pick_and_place",
        robot="panda",
        method="improved",
        verdict=Verdict(outcome, detail),
        objects=(seen(),),
        duration=10 / 3,
        metrics={"length": np.sqrt(2).item()},
        times={"render": 0.1 + 0.2, "execute": 1.0},
    )
