"""Parts of one object become one candidate, alike things are told apart, and prints tell directions."""

from pathlib import Path

import numpy as np
import pytest

import scenes
from cobot_lfd.app.discovery.candidates import BASE, Candidates, find_candidates
from cobot_lfd.detection import Detection
from cobot_lfd.frame import Frame, wrap_angle
from scenes import World, load_scene

pytestmark = pytest.mark.simulator

HANDOVER = (Path(scenes.__file__).parent / "handover.toml").read_text(encoding="utf-8")


def seen(file: Path, content: str, n: int = 3) -> tuple[Candidates, list[dict[str, Frame]]]:
    """The candidates in pictures of a scene, and where its objects were."""
    file.write_text(content, encoding="utf-8")
    scene = load_scene(file)
    pictures, truth = [], []
    for seed in range(n):
        with World(scene, seed) as world:
            pictures.append(world.take_picture())
            truth.append(dict(world.true_frames()))
    return find_candidates(pictures, scene.camera.camera), truth


def test_two_colours_of_one_object_move_as_one(tmp_path: Path) -> None:
    wrist = "high = [0.13, 0.03, 0.045] }"
    assert wrist in HANDOVER
    two_coloured = HANDOVER.replace(wrist, wrist[:-1] + ', colour = "green" }')
    candidates, _ = seen(tmp_path / "two.toml", two_coloured)
    assert [set(motion.members) for motion in candidates.motions] == [{BASE}, {"orange", "green"}, {"blue"}]
    (hand,) = (motion for motion in candidates.motions if "green" in motion.members)
    assert hand.members[0] == "orange"  # It tells the direction; the wrist, a rectangle, does not.
    assert hand.tests[0].holds


def test_what_is_printed_on_a_thing_tells_its_direction_and_walls_its_height(tmp_path: Path) -> None:
    board = '[objects.board]\nprint = { kind = "circuit_board", seed = 3 }'
    candidates, truth = seen(tmp_path / "print.toml", HANDOVER.replace("[objects.board]", board), n=4)
    (printed,) = (model for model in candidates.models.values() if model.found_by == "features")
    turns = []
    for sighting, frames in zip(candidates.tracks[printed.name].sightings, truth, strict=True):
        assert isinstance(sighting, Detection), sighting
        turns.append(sighting.frame.angle - frames["board"].angle)
        assert np.linalg.norm(sighting.frame.position - frames["board"].position) < 0.002  # [m]
    assert max(abs(wrap_angle(turn - turns[0])) for turn in turns) < np.deg2rad(1.0)
    assert printed.z == pytest.approx(0.02, abs=0.006)  # [m]
    assert np.ptp(printed.outline, axis=0) == pytest.approx([0.06, 0.04], abs=0.003)


def test_two_things_that_look_the_same_are_named_from_left_to_right(tmp_path: Path) -> None:
    start, end = HANDOVER.index("[objects.board]"), HANDOVER.index("[objects.hand]")
    second = HANDOVER[start:end].replace("board", "twin").replace("[-0.25, -0.10]", "[-0.05, 0.02]")
    content = (
        HANDOVER[:end] + second.replace('colour = "blue"', 'colour = "blue"\nframe = false') + HANDOVER[end:]
    )
    candidates, truth = seen(tmp_path / "twins.toml", content)
    for n, frames in enumerate(truth):
        for name, thing in (("blue_1", "twin"), ("blue_2", "board")):
            sighting = candidates.tracks[name].sightings[n]
            assert isinstance(sighting, Detection), sighting
            assert np.linalg.norm(sighting.frame.position - frames[thing].position) < 0.002  # [m]
