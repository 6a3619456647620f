"""Scene files: what is read from them, and how their faults are told."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import scenes
from cobot_lfd.errors import DescriptionError
from scenes.description import SceneDescription, load_scene, scene_names
from scenes.placement import draw_placements

PACKAGED = Path(scenes.__file__).parent / "pick_and_place.toml"


def edited(tmp_path: Path, old: str, new: str) -> Path:
    """A copy of the packaged scene in which one piece of text is replaced."""
    text = PACKAGED.read_text(encoding="utf-8")
    assert old in text
    file = tmp_path / "edited.toml"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    return file


def test_every_packaged_scene_can_be_read() -> None:
    assert "pick_and_place" in scene_names()
    for name in scene_names():
        assert set(load_scene(name).objects)


def test_a_scene_is_the_same_by_name_and_by_path() -> None:
    assert load_scene("pick_and_place") == load_scene(PACKAGED)


def test_an_unknown_scene_is_told_with_the_choice() -> None:
    with pytest.raises(DescriptionError, match=r"no scene named 'pik'; choose one of: .*pick_and_place"):
        load_scene("pik")


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match=r"none\.toml: cannot be read"):
        load_scene(tmp_path / "none.toml")


FAULTS = [
    ('"red"', '"rad"', r"edited\.toml: objects\.cube\.colour: 'rad' is no colour name; did you mean 'red'\?"),
    ('"red"', '"qqq"', r"objects\.cube\.colour: 'qqq' is no colour name; choose one of: black, blue"),
    ("mass = 0.05", "mass = -1", r"objects\.cube\.mass: input should be greater than .* 0; given: -1"),
    ("mass = 0.05", "mass = nan", r"objects\.cube\.mass: .*finite"),
    ("mass = 0.05", "mas = 0.05", r"objects\.cube\.mas: is no key that is known here"),
    ("x = [0.35, 0.65]", "x = [0.65, 0.35]", r"objects\.cube\.place\.x: \[0\.65, 0\.35\] is no range"),
    ('shape = "box"', 'shape = "bex"', r"objects\.cube: .*'bex'.*'box'"),
    ("floor = 0.003", "floor = 0.05", r"objects\.container: floor is 0\.05 m thick and the rim 0\.04 m high"),
    ('pick = "cube"', 'pick = "cub"', r"task\.pick: no object named 'cub'; choose one of: cube, cont"),
    (
        'container = "container"\n',
        'container = "cube"\n',
        r"success\.container: 'cube' is no container; choose",
    ),
    ("up = [1.0, 0.0, 0.0]", "up = [0.0, 0.0, 1.0]", r"camera: up must not be parallel"),
    ("[0.3, -0.4, 1.0]", "[0.3, -0.4, -1.0]", r"light: direction has z = -1\.0"),
    ("width = 640", 'width = "wide"', r"camera\.width: .*'wide'"),
    ("[task.hand]", "[task.hand", r"edited\.toml: is no valid TOML"),
    ('title = "Pick', '# "Pick', r"title: is missing"),
]


@pytest.mark.parametrize(("old", "new", "message"), FAULTS)
def test_a_fault_is_told_with_its_key_and_remedy(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(DescriptionError, match=message):
        load_scene(edited(tmp_path, old, new))


def test_placements_keep_their_ranges_and_their_distance() -> None:
    description = load_scene("pick_and_place")
    generator = np.random.default_rng(0)
    for _ in range(200):
        frames = draw_placements(description, generator)
        for name, frame in frames.items():
            place = description.objects[name].place
            for value, (low, high) in zip(frame.position, (place.x, place.y), strict=True):
                assert low <= value <= high
        distance = np.linalg.norm(frames["cube"].position - frames["container"].position)
        assert distance >= description.centre_distance


def test_placements_fill_their_ranges() -> None:
    """Angles and sides are drawn from all of their range, not from a corner of it."""
    generator = np.random.default_rng(0)
    frames = [draw_placements(load_scene("pick_and_place"), generator)["cube"] for _ in range(400)]
    angles, heights = np.array([frame.angle for frame in frames]), np.array([f.position[1] for f in frames])
    assert angles.min() < np.deg2rad(-170)
    assert angles.max() > np.deg2rad(170)
    assert heights.min() < -0.27
    assert heights.max() > 0.27


def test_objects_without_room_are_told() -> None:
    values: dict[str, Any] = tomllib.loads(PACKAGED.read_text(encoding="utf-8"))
    crowded = SceneDescription.model_validate(values | {"centre_distance": 5.0})
    with pytest.raises(DescriptionError, match=r"2 objects found no place 5\.0 m apart; widen their ranges"):
        draw_placements(crowded, np.random.default_rng(0))
