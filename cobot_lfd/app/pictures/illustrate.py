"""What the camera saw of a scene, with what was found in it and the path that was generated."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from cobot_lfd.app.perceive import View
from cobot_lfd.app.pictures.draw import draw_detections
from cobot_lfd.detection import Detection
from cobot_lfd.learning.path import GeneratedPath
from scenes import SceneDescription, object_models


def drawn_view(
    scene: SceneDescription,
    view: View,
    path: GeneratedPath | None,
    *,
    detour: ArrayLike | None = None,
    scale: int = 2,
) -> NDArray[np.uint8]:
    """The camera's picture with frames and path, ``scale`` times as large.

    Args:
        scene: The scene.
        view: What was seen of it; where a model recognises its frames by itself, these are drawn.
        path: The path that was generated; None where it did not come to that.
        detour: The way that was planned instead [m], shape (T, 2); None for no such way.
        scale: Magnification.
    """
    models = object_models(scene)
    learnt = tuple(item for item in view.learnt if isinstance(item, Detection))
    return draw_detections(
        view.picture,
        scene.camera.camera,
        learnt or view.detections,
        models=models,
        path=None if path is None else path.mean,
        detour=detour,
        path_z=next(model.z for model in models if model.name == scene.task.pick),
        scale=scale,
    )
