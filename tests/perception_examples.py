"""Pictures with the truth, for tests of what is seen in them."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame
from perception.picture import Picture
from scenes import World, load_scene, object_models
from scenes.renderer import Renderer

SCENE = load_scene("pick_and_place")
CAMERA = SCENE.camera.camera
MODELS = object_models(SCENE)


@dataclass(frozen=True)
class Shot:
    """A picture and the truth."""

    picture: Picture
    frames: dict[str, Frame]


@cache
def shot(seed: int, renderer: Renderer = "tiny") -> Shot:
    with World(SCENE, seed, renderer=renderer) as world:
        return Shot(world.take_picture(), dict(world.true_frames()))


def errors(detection: Detection | NotSeen, truth: Frame) -> Array:
    """Errors in x [m], y [m] and angle [rad], shape (3,); turns that look the same are none."""
    assert isinstance(detection, Detection), detection
    turn = 2 * np.pi / detection.symmetry
    angle = np.mod(detection.frame.angle - truth.angle + turn / 2, turn) - turn / 2
    return np.array([*(detection.frame.position - truth.position), angle])
