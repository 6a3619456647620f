"""Collects what sensors tell and a hand does while it leads the arm, and makes an episode of it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.pulls import Pulls
from cobot_lfd.app.recording.hand import HandAction
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Verdict
from robots import ArmState

_SAMPLE_PERIOD = 0.01  # [s] between two samples


@dataclass(frozen=True, slots=True)
class _Sample:
    time: float
    state: ArmState
    action: HandAction


@dataclass(slots=True)
class Recorder:
    """What happened so far: the hand's pull in every step of the physics, and samples in steady intervals.

    Attributes:
        time_step: Of the physics [s].
    """

    time_step: float
    _samples: list[_Sample] = field(default_factory=list)
    _actions: list[HandAction] = field(default_factory=list)

    @property
    def n_samples(self) -> int:
        """Number of samples so far."""
        return len(self._samples)

    def add(self, time: float, state: ArmState, action: HandAction) -> None:
        """Add a step of the physics: what the sensors tell before it, and what the hand does in it."""
        if len(self._actions) % steps_per_sample(self.time_step) == 0:
            self._samples.append(_Sample(time, state, action))
        self._actions.append(action)

    def episode(
        self,
        scene: str,
        robot: str,
        seed: int,
        verdict: Verdict,
        picture: NDArray[np.uint8],
        detections: tuple[Detection, ...],
        camera: Camera,
    ) -> RecordedEpisode:
        """The samples as an episode that ended with a verdict.

        Raises:
            DataError: If nothing was recorded.
        """
        if not self._samples:
            raise DataError(
                f"nothing was recorded of seed {seed}; lead the arm before you end the recording."
            )
        states = [sample.state for sample in self._samples]
        actions = [sample.action for sample in self._samples]
        return RecordedEpisode(
            scene=scene,
            robot=robot,
            seed=seed,
            verdict=verdict,
            times=np.array([sample.time for sample in self._samples]),
            joint_positions=np.array([state.positions for state in states]),
            joint_velocities=np.array([state.velocities for state in states]),
            joint_torques=np.array([state.torques for state in states]),
            tool_positions=np.array([state.world_from_tool.position for state in states]),
            tool_quaternions=np.array([state.world_from_tool.quaternion for state in states]),
            gripper_openings=np.array([state.opening for state in states]),
            gripper_orders=np.array([action.opening for action in actions]),
            hand_forces=np.array([action.force for action in actions]),
            hand_torques=np.array([action.torque for action in actions]),
            carrying=np.array([action.carrying for action in actions], dtype=np.bool_),
            picture=picture,
            detections=detections,
            camera=camera,
            pulls=Pulls(
                np.array([action.force for action in self._actions]),
                np.array([action.torque for action in self._actions]),
                np.array([action.opening for action in self._actions]),
            ),
        )


def steps_per_sample(time_step: float) -> int:
    """Number of steps of the physics [s] from one sample to the next."""
    return max(1, round(_SAMPLE_PERIOD / time_step))
