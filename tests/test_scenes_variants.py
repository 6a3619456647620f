"""Variants of scenes: the same task, with wider ranges or with more on the table."""

import tomllib
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import scenes
from cobot_lfd.errors import DescriptionError
from scenes import SceneDescription, load_scene, object_models, scene_names, variant_names
from scenes.placement import draw_placements

ALL = [f"{scene}@{variant}" for scene, variant in product(scene_names(), variant_names())]


@pytest.mark.parametrize("name", ALL)
def test_every_variant_is_the_same_task(name: str) -> None:
    plain, varied = load_scene(name.split("@")[0]), load_scene(name)
    assert varied.task == plain.task
    assert varied.success == plain.success
    assert varied.frame_names == plain.frame_names
    assert varied != plain


@pytest.mark.parametrize("name", [*scene_names(), *ALL])
def test_every_scene_finds_room_for_its_objects_and_shows_them_whole(name: str) -> None:
    description, generator = load_scene(name), np.random.default_rng(0)
    camera = description.camera.camera
    for _ in range(20):
        frames = draw_placements(description, generator)
        for model in object_models(description):
            if description.objects[model.name].frame:
                flat = frames[model.name].apply(model.outline)
                pixels = camera.project(np.column_stack([flat, np.full(len(flat), model.z)]))
                assert (pixels > 1).all()
                assert (pixels < [camera.width - 2, camera.height - 2]).all()


@pytest.mark.parametrize("scene", scene_names())
def test_the_wide_variant_stretches_what_varies_by_half(scene: str) -> None:
    plain, wide = load_scene(scene), load_scene(f"{scene}@wide")
    for name, item in plain.objects.items():
        before, after = item.place, wide.objects[name].place
        assert np.ptp(after.x) == pytest.approx(1.5 * np.ptp(before.x))
        assert np.mean(after.y) == pytest.approx(np.mean(before.y))
        assert np.ptp(after.angle_deg) <= 360.0 + 1e-9


def test_clutter_is_no_parameter_of_the_task() -> None:
    cluttered = load_scene("sorting@clutter")
    extra = set(cluttered.objects) - set(load_scene("sorting").objects)
    assert len(extra) >= 3
    assert not extra & set(cluttered.frame_names)


def test_an_unknown_variant_is_told_with_the_choice() -> None:
    with pytest.raises(DescriptionError, match=r"no variant named 'wild'; choose one of: clutter, wide"):
        load_scene("sorting@wild")


def changed(**changes: object) -> SceneDescription:
    file = Path(scenes.__file__).parent / "sorting.toml"
    values = tomllib.loads(file.read_text(encoding="utf-8"))
    values["objects"]["small_board"] |= changes
    return SceneDescription.model_validate(values)


def test_what_the_camera_does_not_see_must_stand_at_a_fixed_place() -> None:
    with pytest.raises(ValueError, match="seen is false, but place holds ranges"):
        changed(seen=False)


def test_what_the_camera_does_not_see_has_a_known_frame() -> None:
    frames = load_scene("sorting").known_frames
    assert set(frames) == {"green_container", "red_container"}
    assert frames["green_container"].position.tolist() == [0.34, 0.53]
