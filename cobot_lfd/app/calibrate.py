"""A camera is calibrated as in a workshop: it takes pictures of a board that the arm holds before it."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.stats.qmc import Halton

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.errors import DataError
from cobot_lfd.pose import Pose
from perception import Board, BoardView, CameraCalibration, calibrate_camera, find_board
from robots import Arm, Kinematics, RobotDescription
from robots.kinematics import KinematicsError
from scenes import Renderer, SceneDescription, World
from scenes.prints import Print

# The board's poses: where its middle is in the picture, how high above the table [m], how much it leans and
# which way, and how far it is turned from lying beyond the hand as seen from the arm's foot [rad].
_LOWEST = np.array([0.1, 0.1, 0.12, 0.0, -np.pi, -np.deg2rad(75.0)])
_HIGHEST = np.array([0.9, 0.9, 0.45, np.deg2rad(35.0), np.pi, np.deg2rad(75.0)])
_LEAST_SAMPLES = 4  # Points of a pixel that are averaged, so that the board's edges are no stairs.
_MOST_TRIES = 60  # For each view that is wanted.

# The arm holds the board by a handle in the middle of an edge, so that its hand does not cover it; how
# exactly is found out by the calibration. Its face looks to where the tool comes from.
_HANDLE = 0.10  # [m] from the board's edge to the tool


@dataclass(frozen=True, slots=True, eq=False)
class CalibrationSession:
    """What was done and what came out.

    Attributes:
        found: The calibrated camera, with the residual.
        truth: The camera as it really is; only a simulation knows.
        n_views: Number of pictures in which the board was seen.
    """

    found: CameraCalibration
    truth: Camera
    n_views: int

    def errors(self) -> "CalibrationErrors":
        """How far the calibrated camera is from the true one."""
        camera, truth = self.found.camera, self.truth
        focal = np.diag(camera.matrix)[:2] / np.diag(truth.matrix)[:2] - 1.0
        off = camera.world_from_camera.position - truth.world_from_camera.position
        return CalibrationErrors(
            focal_percent=100 * float(np.abs(focal).max()),
            principal_point_px=float(np.linalg.norm(camera.matrix[:2, 2] - truth.matrix[:2, 2])),
            position_mm=1e3 * float(np.linalg.norm(off)),
            angle_deg=float(np.rad2deg(camera.world_from_camera.angle_to(truth.world_from_camera))),
        )


@dataclass(frozen=True, slots=True)
class CalibrationErrors:
    """Errors of a calibrated camera.

    Attributes:
        focal_percent: Larger one of the focal lengths' errors [%].
        principal_point_px: Of the principal point [px].
        position_mm: Of the camera's place [mm].
        angle_deg: Of the camera's direction [degrees].
    """

    focal_percent: float
    principal_point_px: float
    position_mm: float
    angle_deg: float


def calibrate(
    scene: SceneDescription,
    robot: RobotDescription,
    *,
    n_views: int,
    seed: int,
    renderer: Renderer = "tiny",
    report: Callable[[str], None] | None = None,
) -> CalibrationSession:
    """Calibrate a scene's camera by a board that the arm holds before it.

    Args:
        scene: The scene whose camera it is.
        robot: The arm.
        n_views: In how many pictures the board must be seen.
        seed: Decides the poses, and the sensor's noise.
        renderer: What draws the pictures.
        report: Called with a sentence after each picture.

    Raises:
        DataError: If the arm cannot hold the board where the camera sees it often enough.
    """
    samples = max(_LEAST_SAMPLES, scene.camera.samples)
    seen = scene.camera.model_copy(update={"calibration": None, "samples": samples})
    truth, board = seen.true_camera, Board()
    draws = Halton(len(_LOWEST), rng=np.random.default_rng(seed))
    tool_from_board = _held(board)
    views: list[BoardView] = []
    tools: list[Pose] = []
    with World(scene, seed, renderer=renderer) as world, Kinematics(robot) as kinematics:
        arm = Arm(world.client, robot)
        for _ in range(_MOST_TRIES * n_views):
            if len(views) == n_views:
                break
            posture = _posture(kinematics, truth, tool_from_board, robot, draws.random(1)[0])
            if posture is None:
                continue
            arm.body.place(posture)
            tool = arm.state().world_from_tool
            shown = Print(board.image(), board.width, board.height, tool @ tool_from_board)
            view = find_board(world.take_picture(camera=seen, prints=[shown]), board)
            if view is not None:
                views.append(view)
                tools.append(tool)
                if report is not None:
                    report(f"{len(view.points)} corners seen")
    if len(views) < n_views:
        raise DataError(
            f"the board was seen {len(views)} times, not {n_views}; the {robot.title} hardly reaches into "
            "what the camera sees. Ask for fewer --views, or take another --robot."
        )
    return CalibrationSession(calibrate_camera(views, tools, truth.width, truth.height), truth, len(views))


def _held(board: Board) -> Pose:
    """Where the board is in the tool's frame: beside the tool, its face looking back along its axis."""
    return Pose(np.array([0.0, 0.5 * board.height + _HANDLE, 0.0]), np.diag([1.0, -1.0, -1.0]))


def _posture(
    kinematics: Kinematics,
    camera: Camera,
    tool_from_board: Pose,
    robot: RobotDescription,
    draw: Array,
) -> Array | None:
    """Joint positions that hold the board as six numbers in 0..1 say; None where the arm cannot.

    Places in the picture are denser towards its edges: there a lens bends most, and what it does there tells
    the principal point from the camera's direction.
    """
    spread = np.append(0.5 - 0.5 * np.cos(np.pi * draw[:2]), draw[2:])
    column, row, height, tilt, direction, turn = _LOWEST + spread * (_HIGHEST - _LOWEST)
    middle = camera.to_plane(np.array([column * camera.width, row * camera.height]), height)
    away = np.arctan2(middle[1], middle[0]) + turn
    lean = Pose.from_rpy(np.zeros(3), [tilt * np.cos(direction), tilt * np.sin(direction), 0.0])
    world_from_board = Pose.from_rpy([*middle, height], [0.0, 0.0, away + 0.5 * np.pi]) @ lean
    try:
        return kinematics.inverse(world_from_board @ tool_from_board.inverse(), np.array(robot.home))
    except KinematicsError:
        return None
