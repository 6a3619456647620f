"""A thing of the table's own colour is found by its texture alone, if it moves."""

from functools import cache

import numpy as np
import pytest

from cobot_lfd.app.discovery.candidates import BASE, find_candidates
from cobot_lfd.detection import Detection
from cobot_lfd.frame import Frame, wrap_angle
from cobot_lfd.pose import Pose
from perception.discovery import propose, textured
from perception.picture import Picture
from scenes import World, load_scene
from scenes.prints import Print

pytestmark = pytest.mark.simulator

SCENE = load_scene("pick_and_place")
CAMERA = SCENE.camera.camera
PLACES = [Frame(np.array(p), a) for *p, a in ((0.6, 0.0, 0.3), (0.42, 0.02, 2.0), (0.6, 0.24, -1.2))]
SIZE = (0.07, 0.05)  # [m]


def sheet() -> Picture:
    """Squares of other brightness than the table, all in the shares of red, green and blue that it has."""
    with World(SCENE, 0) as world:
        table = world.take_picture()[240, 320] / 255.0
    squares = np.random.default_rng(1).uniform(0.5, 1.2, (10, 14)).repeat(20, axis=0).repeat(20, axis=1)
    # What a print shows of white and black is not all of 0..255; see scenes.prints.
    return np.asarray(np.clip(255 * (squares[..., None] * table - 0.1) / 0.8, 0, 255), np.uint8)


@cache
def pictures(*, still: bool = False) -> tuple[Picture, ...]:
    image = sheet()
    taken = []
    for seed, place in enumerate(PLACES):
        x, y = PLACES[0].position if still else place.position
        pose = Pose.from_rpy([x, y, 0.0005], [0.0, 0.0, PLACES[0].angle if still else place.angle])
        with World(SCENE, seed) as world:
            taken.append(world.take_picture(prints=[Print(image, *SIZE, pose)]))
    return tuple(taken)


def test_texture_alone_makes_a_candidate_that_is_found_again() -> None:
    candidates = find_candidates(pictures(), CAMERA)
    (model,) = (model for model in candidates.models.values() if model.found_by == "features")
    assert np.ptp(model.outline, axis=0) == pytest.approx(SIZE, abs=0.02)
    seen = [item for item in candidates.tracks[model.name].sightings if isinstance(item, Detection)]
    assert len(seen) == len(PLACES)
    offsets = [place.inverse() @ item.frame for place, item in zip(PLACES, seen, strict=True)]
    for offset in offsets:
        assert np.linalg.norm(offset.position - offsets[0].position) < 0.001  # [m]
        assert abs(wrap_angle(offset.angle - offsets[0].angle)) < np.deg2rad(0.5)
    assert {motion.members for motion in candidates.motions if model.name in motion.members} == {
        (model.name,)
    }
    assert BASE in candidates.tracks


def test_what_moves_is_told_from_what_does_not() -> None:
    found = {}
    for still in (False, True):
        taken = pictures(still=still)
        known = [propose(picture, CAMERA) for picture in taken]
        found[still] = len(textured(taken, CAMERA, known))
    assert found == {False: 1, True: 0}
