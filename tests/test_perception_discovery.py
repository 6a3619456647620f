"""Things are found, described and told apart in pictures without being told what they are."""

from functools import cache

import numpy as np
import pytest

from cobot_lfd.detection import Detection, NotSeen, ObjectModel
from cobot_lfd.frame import Frame
from perception.discovery import Track, base_track, describe, match, merge, propose, recognise
from perception.picture import Picture
from scenes import World, load_scene, object_models

pytestmark = pytest.mark.simulator

SCENE = load_scene("pick_and_place@clutter")
CAMERA = SCENE.camera.camera
TRUTH = {model.name: model for model in object_models(SCENE)}
SEEDS = range(5)


@cache
def shot(seed: int) -> tuple[Picture, dict[str, Frame]]:
    with World(SCENE, seed) as world:
        return world.take_picture(), dict(world.true_frames())


@cache
def learnt() -> dict[str, ObjectModel]:
    """What is learnt about each of the scene's objects, under the true name of what lies there."""
    things = [propose(shot(seed)[0], CAMERA) for seed in SEEDS]
    models = {}
    for kind in match(things, CAMERA):
        shown = [(n, i) for n, members in enumerate(kind.members) for i in members]
        regions = [things[n][i] for n, i in shown]
        middle = CAMERA.to_plane(regions[0].region.centroid, 0.02)
        frames = shot(SEEDS[shown[0][0]])[1]
        name = min(frames, key=lambda name: float(np.linalg.norm(frames[name].position - middle)))
        found = describe(name, [shot(SEEDS[n])[0] for n, _ in shown], regions, CAMERA)
        assert found is not None
        models[name] = found.model
    return models


def area(outline: np.ndarray) -> float:
    x, y = outline.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def test_every_object_stands_out_and_its_shadow_does_not() -> None:
    for seed in SEEDS:
        picture, frames = shot(seed)
        middles = np.array([CAMERA.to_plane(t.region.centroid, 0.0) for t in propose(picture, CAMERA)])
        positions = np.array([frame.position for frame in frames.values()])
        assert len(middles) == len(positions)
        assert (np.linalg.norm(middles[:, None] - positions, axis=2).min(axis=1) < 0.015).all()


def test_outline_height_and_symmetry_are_learnt_from_pictures() -> None:
    assert learnt().keys() == TRUTH.keys()
    for name, model in learnt().items():
        assert abs(model.z - TRUTH[name].z) <= 0.005 + 1e-9  # [m], the step of the search
        assert area(model.outline) == pytest.approx(area(TRUTH[name].outline), rel=0.06)
        assert model.symmetry == TRUTH[name].symmetry


def test_things_are_recognised_at_one_place_of_theirs_in_new_pictures() -> None:
    models = tuple(learnt().values())
    for name in ("cube", "container"):
        offsets = []
        for seed in range(20, 24):
            picture, frames = shot(seed)
            seen = {item.name: item for item in recognise(picture, CAMERA, models)}[name]
            assert isinstance(seen, Detection), seen
            offsets.append(np.linalg.norm(seen.frame.position - frames[name].position))
        assert max(offsets) < 0.002  # [m]


def test_a_picture_without_the_thing_says_so() -> None:
    with World(load_scene("pick_and_place"), 0) as world:
        picture, covered = world.take_picture(), world.take_picture(covered=True)
    black = recognise(picture, CAMERA, [learnt()["clutter_black"]])[0]
    assert isinstance(black, NotSeen)
    assert "colour" in black.reason
    dark = recognise(covered, CAMERA, [learnt()["cube"]])[0]
    assert isinstance(dark, NotSeen)
    assert "covered" in dark.reason


def track(name: str, frames: list[Frame], symmetry: int = 1) -> Track:
    covariance = np.diag([1e-8, 1e-8, 1e-6])
    seen = [Detection(name, frame, symmetry, covariance, 1.0, np.zeros((0, 2))) for frame in frames]
    return Track(name, tuple(seen))


def frames_at_random(rng: np.random.Generator, n: int) -> list[Frame]:
    return [Frame(rng.uniform(-0.2, 0.2, 2), rng.uniform(-3, 3)) for _ in range(n)]


@pytest.mark.parametrize("symmetry", [1, 2, 4])
def test_parts_of_one_object_are_merged_and_strangers_are_not(symmetry: int) -> None:
    rng = np.random.default_rng(symmetry)
    offset = Frame(np.array([0.05, -0.02]), 0.4)
    poses = frames_at_random(rng, 6)
    turned = [
        pose @ offset @ Frame(np.zeros(2), 2 * np.pi * rng.integers(symmetry) / symmetry) for pose in poses
    ]
    tracks = [
        track("head", poses),
        track("handle", turned, symmetry),
        track("other", frames_at_random(rng, 6)),
    ]
    groups = [set(motion.members) for motion in merge([base_track("base", 6), *tracks])]
    assert groups == [{"base"}, {"head", "handle"}, {"other"}]


def test_what_never_moves_is_one_with_the_base_even_where_it_is_hidden_once() -> None:
    still = track("box", [Frame(np.array([0.3, 0.2]), 0.5)] * 5, 4)
    hidden = Track("box", (*still.sightings, NotSeen("box", "covered")))
    (motion,) = merge([base_track("base", 6), hidden])
    assert motion.members == ("base", "box")


def test_a_rounded_outline_of_many_short_sides_is_found() -> None:
    """None of its sides is long enough for edges to be looked for at a few places only."""
    angles = np.sort(np.random.default_rng(0).uniform(0.0, 0.3, 13) + np.arange(13) * 2 * np.pi / 13)
    outline = 0.0196 * np.column_stack([np.cos(angles), np.sin(angles)])
    scene = load_scene("ball_in_hole")
    with World(scene, 3) as world:
        picture, truth = world.take_picture(), world.true_frames()["ball"]
    camera = scene.camera.camera
    things = propose(picture, camera)
    red = next(thing for thing in things if thing.region.colour.argmax() == 0)
    ball = ObjectModel("ball", outline, 0.02, red.region.colour / 255.0, 8, np.full(13, 0.02))
    (seen,) = recognise(picture, camera, [ball], things)
    assert isinstance(seen, Detection), seen
    assert np.linalg.norm(seen.frame.position - truth.position) < 0.001  # [m]
