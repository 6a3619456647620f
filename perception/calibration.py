"""What a camera's lens is like, and where the camera stands on the robot's base, from views of a board."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.errors import DataError
from cobot_lfd.pose import Pose
from perception.board import BoardView

FEWEST_VIEWS = 6
"""Of a board; fewer do not tell a camera."""

_N_CAMERA = 14  # Unknowns of a camera: its pose, focal lengths, principal point, and k1, k2, p1, p2.
_LEAST_TURN = np.deg2rad(10)  # Between the tool's poses, about two axes; else the camera's place is not told.


@dataclass(frozen=True, slots=True, eq=False)
class LensCalibration:
    """What a camera's lens is like.

    Attributes:
        matrix: Intrinsic matrix [px], shape (3, 3).
        distortion: Coefficients k1, k2, p1, p2, k3, shape (5,).
        camera_from_board: Where the board was in each view.
        residual: Root mean square distance of the corners from where they should be [px].
    """

    matrix: Array
    distortion: Array
    camera_from_board: tuple[Pose, ...]
    residual: float


@dataclass(frozen=True, slots=True, eq=False)
class CameraCalibration:
    """A camera that is known completely.

    Attributes:
        camera: The camera, in the robot base's frame.
        tool_from_board: How the tool held the board.
        residual: Root mean square distance of the corners from where they should be [px].
    """

    camera: Camera
    tool_from_board: Pose
    residual: float


def calibrate_lens(views: Sequence[BoardView], width: int, height: int) -> LensCalibration:
    """Focal lengths, principal point and distortion from views of a board in several poses.

    The sixth power of the distance from the centre (k3) is left out: a board tells it hardly from the fourth.

    Args:
        views: What was seen of the board, at least six times.
        width: Width of the pictures [px].
        height: Height of the pictures [px].

    Raises:
        DataError: If there are too few views.
    """
    _check_number(views)
    residual, matrix, distortion, turns, shifts = cv2.calibrateCamera(
        [view.points.astype(np.float32) for view in views],
        [view.pixels.astype(np.float32) for view in views],
        (width, height),
        np.eye(3),
        np.zeros(5),
        flags=cv2.CALIB_FIX_K3,
    )
    poses = tuple(
        Pose(np.ravel(shift), Rotation.from_rotvec(np.ravel(turn)).as_matrix())
        for turn, shift in zip(turns, shifts, strict=True)
    )
    coefficients = np.asarray(distortion, np.float64).ravel()[:5]
    return LensCalibration(np.asarray(matrix, np.float64), coefficients, poses, float(residual))


def calibrate_camera(
    views: Sequence[BoardView], base_from_tool: Sequence[Pose], width: int, height: int
) -> CameraCalibration:
    """The lens, and where the camera stands, from views of a board that the arm holds in several poses.

    A first estimate comes from ``calibrate_lens`` and from the chain
    ``base_from_tool tool_from_board = base_from_camera camera_from_board``, solved linearly for the two
    unknown poses. Then everything is improved together until the corners land best where they were seen.

    Args:
        views: What was seen of the board, at least six times.
        base_from_tool: Where the tool was each time; it must turn about more than one axis.
        width: Width of the pictures [px].
        height: Height of the pictures [px].

    Raises:
        DataError: If there are too few views, or the tool turned too little.
        ValueError: If there is not one pose for each view.
    """
    if len(views) != len(base_from_tool):
        raise ValueError(f"there are {len(views)} views and {len(base_from_tool)} poses; give one for each.")
    _check_number(views)
    _check_turns(base_from_tool)
    lens = calibrate_lens(views, width, height)
    base_from_camera, tool_from_board = _first_estimate(base_from_tool, lens.camera_from_board)
    start = Camera(width, height, lens.matrix, base_from_camera, lens.distortion)

    def errors(unknowns: Array) -> Array:
        camera, held = _adjusted(start, unknowns[6:]), _moved(tool_from_board, unknowns[:6])
        expected = [
            camera.project((tool @ held).apply(v.points))
            for tool, v in zip(base_from_tool, views, strict=True)
        ]
        return np.concatenate([(e - v.pixels).ravel() for e, v in zip(expected, views, strict=True)])

    best = least_squares(errors, np.zeros(6 + _N_CAMERA), x_scale="jac").x
    residual = float(np.sqrt(2 * np.mean(errors(best) ** 2)))
    return CameraCalibration(_adjusted(start, best[6:]), _moved(tool_from_board, best[:6]), residual)


def _adjusted(camera: Camera, step: Array) -> Camera:
    """A camera with another pose, focal lengths, principal point and coefficients; k3 stays."""
    matrix = camera.matrix.copy()
    matrix[[0, 1, 0, 1], [0, 1, 2, 2]] += step[6:10]
    distortion = camera.distortion + np.append(step[10:14], 0.0)
    pose = _moved(camera.world_from_camera, step[:6])
    return Camera(camera.width, camera.height, matrix, pose, distortion)


def _check_number(views: Sequence[BoardView]) -> None:
    if len(views) < FEWEST_VIEWS:
        raise DataError(
            f"the board was seen {len(views)} times; at least {FEWEST_VIEWS} views are needed. "
            "Take more pictures, with all of the board in them."
        )


def _check_turns(base_from_tool: Sequence[Pose]) -> None:
    """The tool must turn about two axes at least; then the turns span a plane."""
    first = base_from_tool[0].rotation
    turns = [Rotation.from_matrix(first.T @ pose.rotation).as_rotvec() for pose in base_from_tool]
    spread = np.linalg.svd(turns, compute_uv=False)[1] / np.sqrt(len(turns))
    if spread < _LEAST_TURN / 2:
        raise DataError(
            f"the tool turned by only {np.rad2deg(spread):.1f}° about its second axis; the camera's place "
            "cannot be told. Tilt the board this way and that between the pictures."
        )


def _first_estimate(base_from_tool: Sequence[Pose], camera_from_board: Sequence[Pose]) -> tuple[Pose, Pose]:
    """Poses X = base_from_camera and Y = tool_from_board with ``A Y = X B`` for all A, B, by linear algebra.

    The rotations solve ``R_A R_Y = R_X R_B``, linear in the entries of both; what comes out is brought to the
    nearest rotations. Then the positions solve ``R_A t_Y - t_X = R_X t_B - t_A``.
    """
    pairs = list(zip(base_from_tool, camera_from_board, strict=True))
    rows = [np.hstack([np.kron(a.rotation, np.eye(3)), -np.kron(np.eye(3), b.rotation.T)]) for a, b in pairs]
    solution = np.linalg.svd(np.vstack(rows))[2][-1].reshape(2, 3, 3)
    solution = solution * np.sign(np.linalg.det(solution[0]))
    R_Y, R_X = (_nearest_rotation(matrix) for matrix in solution)
    left = np.vstack([np.hstack([a.rotation, -np.eye(3)]) for a, _ in pairs])
    right = np.concatenate([R_X @ b.position - a.position for a, b in pairs])
    t_Y, t_X = np.linalg.lstsq(left, right, rcond=None)[0].reshape(2, 3)
    return Pose(t_X, R_X), Pose(t_Y, R_Y)


def _nearest_rotation(matrix: Array) -> Array:
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right)


def _moved(pose: Pose, step: Array) -> Pose:
    """A pose moved by three numbers [m] and turned by a rotation vector [rad]."""
    return Pose(pose.position + step[:3], Rotation.from_rotvec(step[3:]).as_matrix() @ pose.rotation)
