"""What perception is told to look for in a scene; objects that features find have been looked at before."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from cobot_lfd.appearance import Appearance
from cobot_lfd.detection import ObjectModel
from perception import learn_appearance
from scenes import Renderer, SceneDescription, object_models, take_portrait


def sought(scene: SceneDescription, renderer: Renderer = "tiny") -> tuple[ObjectModel, ...]:
    """A model of each object that the camera sees; those that features find have been looked at once.

    Args:
        scene: The scene.
        renderer: What draws its pictures.
    """
    return tuple(
        replace(model, appearance=_appearance(scene.model_dump_json(), model.name, renderer))
        if model.found_by == "features"
        else model
        for model in object_models(scene)
    )


@lru_cache(maxsize=64)
def _appearance(scene_json: str, name: str, renderer: Renderer) -> Appearance:
    """What an object's face looks like, learnt from one picture of it; JSON describes the scene."""
    scene = SceneDescription.model_validate_json(scene_json)
    model = next(model for model in object_models(scene) if model.name == name)
    portrait = take_portrait(scene, name, renderer)
    corners = portrait.frame.apply(model.outline)
    camera = scene.camera.camera
    region = camera.project(np.column_stack([corners, np.full(len(corners), model.z)]))
    return learn_appearance(name, portrait.picture, camera, model.z, region, frame=portrait.frame)
