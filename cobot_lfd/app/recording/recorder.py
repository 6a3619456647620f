"""Collects what sensors tell while a hand leads the arm, and makes an episode of it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.recording.hand import HandAction
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Verdict
from robots import ArmState


@dataclass(slots=True)
class Recorder:
    """The samples so far.

    Attributes:
        samples: Time [s], state of the arm and action of the hand, in the order of time.
    """

    samples: list[tuple[float, ArmState, HandAction]] = field(default_factory=list)

    def add(self, time: float, state: ArmState, action: HandAction) -> None:
        """Add a sample."""
        self.samples.append((time, state, action))

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
        if not self.samples:
            raise DataError(
                f"nothing was recorded of seed {seed}; lead the arm before you end the recording."
            )
        times, states, actions = zip(*self.samples, strict=True)
        return RecordedEpisode(
            scene=scene,
            robot=robot,
            seed=seed,
            verdict=verdict,
            times=np.array(times),
            joint_positions=np.array([state.positions for state in states]),
            joint_velocities=np.array([state.velocities for state in states]),
            joint_torques=np.array([state.torques for state in states]),
            tool_positions=np.array([state.world_from_tool.position for state in states]),
            tool_quaternions=np.array([state.world_from_tool.quaternion for state in states]),
            gripper_openings=np.array([state.opening for state in states]),
            hand_forces=np.array([action.force for action in actions]),
            hand_torques=np.array([action.torque for action in actions]),
            carrying=np.array([action.carrying for action in actions], dtype=np.bool_),
            picture=picture,
            detections=detections,
            camera=camera,
        )
