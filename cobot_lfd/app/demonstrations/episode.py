"""A recorded episode: everything that one demonstration left behind."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.app.demonstrations.pulls import Pulls
from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.camera import Camera
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Verdict


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RecordedEpisode:
    """What the physics and the camera recorded while a hand dragged the arm through a task.

    All series have one entry per sample, ``M`` in number; the arm has ``n`` joints.

    Attributes:
        scene: Name of the scene.
        robot: Name of the robot.
        seed: Seed from which the scene's layout and the hand's variation were drawn, at least 0.
        verdict: How the episode ended.
        times: Time of each sample [s], strictly increasing, shape (M,).
        joint_positions: Joint angles [rad], shape (M, n).
        joint_velocities: Joint velocities [rad/s], shape (M, n).
        joint_torques: Torques that the motors apply [N m], shape (M, n).
        tool_positions: Position of the tool in the world [m], shape (M, 3).
        tool_quaternions: Rotation of the tool in the world, unit quaternions x, y, z, w, shape (M, 4).
        gripper_openings: Distance between the fingers [m], shape (M,).
        gripper_orders: What the gripper was told [m], shape (M,).
        hand_forces: Force of the hand on the tool, in the world [N], shape (M, 3).
        hand_torques: Torque of the hand on the tool, in the world [N m], shape (M, 3).
        carrying: Whether the sample belongs to the planar carry, shape (M,).
        picture: What the camera saw before the hand touched the arm, RGB uint8, shape (H, W, 3).
        detections: The objects that were found in the picture.
        camera: The camera that took the picture; None where the recording does not tell.
        pulls: What the hand did in every step of the physics; none where that was not recorded.
    """

    scene: str
    robot: str
    seed: int
    verdict: Verdict
    times: Array
    joint_positions: Array
    joint_velocities: Array
    joint_torques: Array
    tool_positions: Array
    tool_quaternions: Array
    gripper_openings: Array
    gripper_orders: Array
    hand_forces: Array
    hand_torques: Array
    carrying: NDArray[np.bool_]
    picture: NDArray[np.uint8]
    detections: tuple[Detection, ...]
    camera: Camera | None = None
    pulls: Pulls = field(default_factory=Pulls.none)

    def __post_init__(self) -> None:
        """Copy and check."""
        if self.seed < 0:
            raise ValueError(f"seed is {self.seed}; it must be at least 0.")
        object.__setattr__(self, "times", frozen_array(self.times, "times", (None,)))
        if (np.diff(self.times) <= 0).any():
            raise ValueError("times must be strictly increasing; record every sample once, in order.")
        n_samples, n_joints = len(self.times), np.shape(self.joint_positions)[-1]
        for name, columns in _series(n_joints).items():
            object.__setattr__(self, name, frozen_array(getattr(self, name), name, (n_samples, *columns)))
        object.__setattr__(self, "carrying", _frozen_flags(self.carrying, n_samples))
        object.__setattr__(self, "picture", _frozen_picture(self.picture))
        object.__setattr__(self, "detections", tuple(self.detections))

    def demonstration(self) -> Demonstration:
        """The planar path of the carry, with the frames that perception found before it.

        Raises:
            DataError: If nothing was carried or no object was found, so that there is nothing to learn from.
        """
        n_carried = int(self.carrying.sum())
        if n_carried < 2:
            raise DataError(
                f"the episode of seed {self.seed} has {n_carried} samples of a carry; a demonstration needs "
                "at least 2. Record it again."
            )
        if not self.detections:
            raise DataError(
                f"the episode of seed {self.seed} has no detected object, so its path has no frame. "
                "Record it again with the objects in the camera's view."
            )
        frames = {detection.name: detection.frame for detection in self.detections}
        return Demonstration(self.tool_positions[self.carrying, :2], frames, self.times[self.carrying])


def _series(n_joints: int) -> dict[str, tuple[int, ...]]:
    """The recorded series by name, with the shape of one sample."""
    return {
        "joint_positions": (n_joints,),
        "joint_velocities": (n_joints,),
        "joint_torques": (n_joints,),
        "tool_positions": (3,),
        "tool_quaternions": (4,),
        "gripper_openings": (),
        "gripper_orders": (),
        "hand_forces": (3,),
        "hand_torques": (3,),
    }


def _frozen_flags(value: NDArray[np.bool_], n_samples: int) -> NDArray[np.bool_]:
    flags = np.array(value)
    if flags.dtype != np.bool_ or flags.shape != (n_samples,):
        raise ValueError(
            f"carrying has shape {flags.shape} and type {flags.dtype}; it must be ({n_samples},) of bool."
        )
    flags.setflags(write=False)
    return flags


def _frozen_picture(value: NDArray[np.uint8]) -> NDArray[np.uint8]:
    picture = np.array(value)
    if picture.dtype != np.uint8 or picture.ndim != 3 or picture.shape[2] != 3:
        raise ValueError(
            f"picture has shape {picture.shape} and type {picture.dtype}; "
            "it must be (height, width, 3) of uint8."
        )
    picture.setflags(write=False)
    return picture
