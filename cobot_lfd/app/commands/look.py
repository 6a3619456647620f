"""cobot-lfd look: what the camera sees of a scene, and what perception makes of it."""

from pathlib import Path

import numpy as np

from cobot_lfd.app.commands.exit_codes import DONE, NOT_ALL_SUCCEEDED
from cobot_lfd.app.commands.options import require_at_least
from cobot_lfd.app.perceive import View, perceive
from cobot_lfd.app.pictures.draw import draw_detections, require_picture_file, save_picture
from cobot_lfd.app.sought import sought
from cobot_lfd.detection import Detection
from scenes import Renderer, World, load_scene


def look(
    *, scene: str, out: Path, seed: int = 0, renderer: Renderer = "tiny", camera: Path | None = None
) -> int:
    """Look at a scene: draw outline, axes, name, confidence and error ellipse of all that is detected.

    Args:
        scene: Name of the scene, or of a variant (sorting@clutter), or its file.
        out: File (.png) for the picture.
        seed: Decides where the objects stand.
        renderer: What draws the scene: tiny needs nothing, egl draws other colours and shadows.
        camera: File of a calibrated camera (cobot-lfd calibrate), by which the picture is read.
    """
    require_at_least(0, "seed", seed)
    require_picture_file(out)
    described = load_scene(scene, calibration=camera)
    with World(described, seed, renderer=renderer) as world:
        view = perceive(world)
    found = [item for item in (*view.detections, *view.others) if described.objects[item.name].seen]
    picture = draw_detections(
        view.picture, described.camera.camera, found, models=sought(described, renderer), judged=True
    )
    _tell(found, view)
    print(save_picture(picture, out))
    return NOT_ALL_SUCCEEDED if view.missing else DONE


def _tell(found: list[Detection], view: View) -> None:
    """A line for each object that was found, or was not."""
    for item in found:
        x, y = 1e3 * item.frame.position
        sigma = np.sqrt(np.diag(item.covariance))
        turns = f", alike every {360 / item.symmetry:.0f}°" if item.symmetry > 1 else ""
        print(
            f"{item.name}: x {x:.2f}, y {y:.2f} mm (±{1e3 * np.hypot(*sigma[:2]):.2f}), "
            f"{np.rad2deg(item.frame.angle):.2f}° (±{np.rad2deg(sigma[2]):.2f}){turns}, "
            f"confidence {100 * item.confidence:.0f} %"
        )
    for missing in view.missing:
        print(f"{missing.name}: not seen; {missing.reason}")
