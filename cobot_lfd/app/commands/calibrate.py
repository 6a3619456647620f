"""cobot-lfd calibrate: what a scene's camera is like and where it stands, from pictures of a board."""

from pathlib import Path

import numpy as np

from cobot_lfd.app.calibrate import CalibrationSession
from cobot_lfd.app.calibrate import calibrate as calibrate_scene
from cobot_lfd.app.commands.exit_codes import DONE
from cobot_lfd.app.commands.options import require_at_least
from cobot_lfd.app.disk import require_folder, told
from cobot_lfd.app.progress import progress
from cobot_lfd.camera_file import save_camera
from perception import FEWEST_VIEWS
from robots import load_robot
from scenes import Renderer, load_scene


def calibrate(
    *,
    scene: str,
    out: Path,
    robot: str = "panda",
    views: int = 20,
    seed: int = 0,
    renderer: Renderer = "tiny",
) -> int:
    """Calibrate a scene's camera: it takes pictures of a board that the arm holds before it in many poses.

    Args:
        scene: Name of the scene, or its file.
        out: File (.toml) for the calibrated camera; a scene's file can name it as camera.calibration.
        robot: Name of the robot that holds the board.
        views: In how many pictures the board must be seen; at least 6.
        seed: Decides the poses, and the noise of the camera.
        renderer: What draws the pictures.
    """
    require_at_least(FEWEST_VIEWS, "views", views)
    require_at_least(0, "seed", seed)
    require_folder(out)
    described = load_scene(scene)
    with progress("calibrating", views) as report:
        session = calibrate_scene(
            described, load_robot(robot), n_views=views, seed=seed, renderer=renderer, report=report
        )
    _tell(session)
    with told(out, "write"):
        save_camera(session.found.camera, out)
    print(out)
    return DONE


def _tell(session: CalibrationSession) -> None:
    """What came out, and, since this is a simulation, how far it is from the truth."""
    camera, errors = session.found.camera, session.errors()
    fx, fy = np.diag(camera.matrix)[:2]
    cx, cy = camera.matrix[:2, 2]
    x, y, z = camera.world_from_camera.position
    print(
        f"{session.n_views} views; the corners are off by {session.found.residual:.3f} px (root mean square)"
    )
    print(f"focal lengths {fx:.2f}, {fy:.2f} px: off by {errors.focal_percent:.3f} %")
    print(f"principal point {cx:.2f}, {cy:.2f} px: off by {errors.principal_point_px:.2f} px")
    print(f"distortion {', '.join(f'{value:.4f}' for value in camera.distortion)}")
    print(
        f"position {x:.4f}, {y:.4f}, {z:.4f} m: off by {errors.position_mm:.2f} mm, "
        f"direction by {errors.angle_deg:.3f}°"
    )
