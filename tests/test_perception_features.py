"""Objects are found by what is on their faces, learnt from one picture; what is not there is not invented."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import gaussian_filter

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame, wrap_angle
from cobot_lfd.pose import Pose
from perception import FeatureDetector, learn_appearance
from perception.keypoints import FeatureKind
from perception.picture import Picture
from perception.rigid import on_plane
from scenes.artwork import CircuitBoard, Label, draw_artwork
from scenes.prints import Print, draw_prints

CAMERA = Camera.looking_at(
    [0.5, 0.0, 1.2], [0.5, 0.0, 0.0], up=[1, 0, 0], field_of_view=0.5, width=640, height=480
)
TABLE = np.full((480, 640, 3), (180, 168, 150), dtype=np.uint8)
Z = 0.02
SIZES = {"large": (0.10, 0.07), "small": (0.06, 0.04), "parcel": (0.08, 0.05)}
ARTWORKS = {
    "large": draw_artwork(CircuitBoard(kind="circuit_board", seed=1), SIZES["large"]),
    "small": draw_artwork(CircuitBoard(kind="circuit_board", seed=2), SIZES["small"]),
    "parcel": draw_artwork(Label(kind="label", seed=1), SIZES["parcel"]),
}


def picture_of(things: dict[str, tuple[str, Frame]]) -> Picture:
    """A picture of faces that lie on the table: a name, its look and its frame each."""
    prints = [
        Print(ARTWORKS[look], *SIZES[look], Pose.from_rpy([*frame.position, Z], [0, 0, frame.angle]))
        for look, frame in things.values()
    ]
    return draw_prints(TABLE, CAMERA, prints, np.full(TABLE.shape[:2], 1.25))


def outline_of(look: str) -> Array:
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return np.asarray(signs * np.array(SIZES[look]) / 2)


@cache
def appearance(look: str) -> Appearance:
    frame = Frame(np.array([0.5, 0.0]), 0.45)
    region = CAMERA.project(on_plane(frame.apply(outline_of(look)), Z))
    return learn_appearance(look, picture_of({look: (look, frame)}), CAMERA, Z, region, frame=frame)


APPEARANCES = tuple(appearance(look) for look in SIZES)


def layout(seed: int) -> dict[str, tuple[str, Frame]]:
    """One of each, side by side in some order."""
    generator = np.random.default_rng(seed)
    middles = generator.permutation([0.17, 0.0, -0.17])
    return {
        look: (look, Frame(np.array([generator.uniform(0.42, 0.58), y]), generator.uniform(-np.pi, np.pi)))
        for look, y in zip(SIZES, middles, strict=True)
    }


def errors(detection: Detection | NotSeen, truth: Frame) -> Array:
    assert isinstance(detection, Detection), detection
    return np.array(
        [*(detection.frame.position - truth.position), wrap_angle(detection.frame.angle - truth.angle)]
    )


@pytest.mark.parametrize("kind", ["sift", "orb"])
def test_faces_are_found_where_they_are_with_their_whole_angle(kind: FeatureKind) -> None:
    off = []
    for seed in range(6):
        things = layout(seed)
        found = FeatureDetector(APPEARANCES, kind).detect(picture_of(things), CAMERA)
        off += [errors(d, things[d.name][1]) for d in found]
    assert np.median(np.linalg.norm(np.array(off)[:, :2], axis=1)) < 0.1e-3
    assert np.linalg.norm(np.array(off)[:, :2], axis=1).max() < 0.3e-3
    assert np.abs(np.array(off)[:, 2]).max() < np.deg2rad(0.4)


def spoilt(picture: Picture, blur: float, exposure: float, noise: float, seed: int) -> Picture:
    """The picture as a bad camera takes it."""
    smooth = gaussian_filter(picture.astype(float), (blur, blur, 0.0)) if blur else picture
    noisy = exposure * smooth + np.random.default_rng(seed).normal(scale=noise, size=picture.shape)
    return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("blur", "exposure", "noise"), [(0.0, 1.0, 6.0), (1.2, 0.6, 6.0)])
def test_the_covariance_tells_how_far_off_a_pose_is(blur: float, exposure: float, noise: float) -> None:
    normalised = []
    for seed in range(8):
        things = layout(seed)
        picture = spoilt(picture_of(things), blur, exposure, noise, seed)
        for d in FeatureDetector(APPEARANCES).detect(picture, CAMERA):
            assert isinstance(d, Detection), d
            off = errors(d, things[d.name][1])
            normalised.append(off @ np.linalg.solve(d.covariance, off))
    assert 0.5 < np.mean(normalised) / 3 < 2.0


def test_a_blurred_noisy_picture_shows_every_face() -> None:
    """Where noise leaves no point of a small face, the face as a whole is found."""
    for seed in range(3):
        things = layout(seed)
        picture = spoilt(picture_of(things), 1.5, 0.5, 8.0, seed)
        for d in FeatureDetector(APPEARANCES).detect(picture, CAMERA):
            off = errors(d, things[d.name][1])
            assert np.linalg.norm(off[:2]) < 0.6e-3
            assert abs(off[2]) < np.deg2rad(1.0)


@pytest.mark.parametrize("light", [0.55, 1.2])
def test_light_changes_nothing(light: float) -> None:
    things = layout(1)
    picture = np.clip(light * picture_of(things), 0, 255).astype(np.uint8)
    for d in FeatureDetector(APPEARANCES).detect(picture, CAMERA):
        assert np.linalg.norm(errors(d, things[d.name][1])[:2]) < 0.5e-3


def covered(picture: Picture, look: str, frame: Frame, share: float, side: int) -> Picture:
    """The picture with a grey strip over a share of a face, from one of its four sides."""
    axis, sign = side % 2, 1 if side < 2 else -1
    low, high = outline_of(look).min(axis=0), outline_of(look).max(axis=0)
    edge = high[axis] if sign > 0 else low[axis]
    v, u = np.indices(picture.shape[:2])
    local = frame.localise(CAMERA.to_plane(np.stack([u, v], axis=-1), Z))
    inside = (np.abs(local) < 1.2 * high).all(axis=-1)
    strip = inside & (sign * local[..., axis] > sign * edge - share * 2 * high[axis])
    return np.where(strip[..., None], np.array([95, 100, 105]), picture).astype(np.uint8)


@pytest.mark.parametrize("side", range(4))
def test_a_third_of_a_face_may_be_covered(side: int) -> None:
    things = layout(side)
    for look, frame in things.values():
        picture = covered(picture_of(things), look, frame, 0.33, side)
        found = FeatureDetector((appearance(look),)).detect(picture, CAMERA)[0]
        off = errors(found, frame)
        assert np.linalg.norm(off[:2]) < 1.0e-3
        assert abs(off[2]) < np.deg2rad(1.0)
        assert isinstance(found, Detection)
        assert 0.5 < found.confidence < 0.85


def test_a_face_that_is_mostly_covered_is_not_seen() -> None:
    things = layout(0)
    look, frame = things["large"]
    picture = covered(picture_of(things), look, frame, 0.85, 0)
    found = FeatureDetector(APPEARANCES).detect(picture, CAMERA)
    assert isinstance(found[0], NotSeen)
    assert all(isinstance(d, Detection) for d in found[1:])


def test_faces_that_look_the_same_are_named_from_left_to_right() -> None:
    twins = tuple(replace(appearance("parcel"), name=name) for name in ("first", "second", "third"))
    left, right = Frame(np.array([0.45, 0.12]), 0.4), Frame(np.array([0.55, -0.12]), 2.4)
    picture = picture_of(
        {"a": ("parcel", right), "b": ("parcel", left), "c": ("large", Frame(np.array([0.5, 0.0]), 1.0))}
    )
    first, second, third = FeatureDetector(twins).detect(picture, CAMERA)
    assert np.linalg.norm(errors(first, left)[:2]) < 0.3e-3
    assert np.linalg.norm(errors(second, right)[:2]) < 0.3e-3
    assert isinstance(third, NotSeen)


@pytest.mark.parametrize("seed", range(4))
def test_a_face_that_is_not_there_is_not_seen(seed: int) -> None:
    things = {name: thing for name, thing in layout(seed).items() if name != "small"}
    _, small, _ = FeatureDetector(APPEARANCES).detect(picture_of(things), CAMERA)
    assert isinstance(small, NotSeen)


def test_an_empty_table_shows_no_face() -> None:
    found = FeatureDetector(APPEARANCES).detect(TABLE, CAMERA)
    assert found[0] == NotSeen("large", "nothing in the picture looks like the large.")


def test_a_dark_picture_shows_nothing_and_the_reason_is_told() -> None:
    (found,) = FeatureDetector(APPEARANCES[:1]).detect(np.zeros_like(TABLE), CAMERA)
    assert found == NotSeen("large", "the picture is too dark; is the camera covered?")


@pytest.mark.parametrize("y", [0.215, 0.235, 0.25, 0.27])
def test_a_face_at_the_pictures_edge_is_found_where_it_is_or_not_at_all(y: float) -> None:
    frame = Frame(np.array([0.5, y]), 0.7)
    (found,) = FeatureDetector(APPEARANCES[:1]).detect(picture_of({"large": ("large", frame)}), CAMERA)
    if isinstance(found, Detection):
        assert np.linalg.norm(errors(found, frame)[:2]) < 1e-3


def test_a_face_is_learnt_from_a_region_alone() -> None:
    """Without a frame the frame is put in the region's middle, its axes along the world's."""
    where = Frame(np.array([0.52, 0.03]), 0.0)
    region = CAMERA.project(on_plane(where.apply(outline_of("large")), Z))
    learnt = learn_appearance("large", picture_of({"large": ("large", where)}), CAMERA, Z, region)
    moved = Frame(np.array([0.45, -0.1]), 1.3)
    (found,) = FeatureDetector((learnt,)).detect(picture_of({"large": ("large", moved)}), CAMERA)
    assert np.linalg.norm(errors(found, moved)[:2]) < 0.3e-3


def test_an_appearance_survives_being_stored_as_arrays(tmp_path: Path) -> None:
    one = appearance("small")
    np.savez(
        tmp_path / "look.npz", image=one.image, outline=one.outline, origin=one.origin,
        numbers=[one.metres_per_pixel, one.z],
    )  # fmt: skip
    with np.load(tmp_path / "look.npz", allow_pickle=False) as stored:
        metres_per_pixel, z = stored["numbers"]
        again = Appearance("small", stored["image"], stored["outline"], metres_per_pixel, z, stored["origin"])
    things = layout(2)
    before, after = (FeatureDetector((a,)).detect(picture_of(things), CAMERA)[0] for a in (one, again))
    assert_allclose(errors(after, things["small"][1]), errors(before, things["small"][1]), atol=1e-12)


def test_the_map_and_the_frame_agree() -> None:
    one = appearance("parcel")
    assert_allclose(
        one.to_pixels(one.to_local([[3.0, 5.0], [0.0, 0.0]])), [[3.0, 5.0], [0.0, 0.0]], atol=1e-9
    )
    assert_allclose(one.to_local(one.origin), [0.0, 0.0], atol=1e-12)
    assert_allclose(np.ptp(one.outline, axis=0), SIZES["parcel"], rtol=1e-6)


def test_a_region_beyond_the_picture_or_too_small_is_told() -> None:
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    with pytest.raises(ValueError, match=r"the region reaches beyond the picture of 640 x 480 px"):
        learn_appearance("x", TABLE, CAMERA, Z, 50 * square - 10)
    with pytest.raises(ValueError, match=r"the region has 4 corners and extends over 5 x 5 px; it needs"):
        learn_appearance("x", TABLE, CAMERA, Z, 5 * square + 100)


def test_an_appearance_that_is_no_picture_is_told() -> None:
    no_picture: Any = np.zeros((3, 3))
    with pytest.raises(ValueError, match=r"image of 'x' has shape \(3, 3\) and type float64; it must"):
        Appearance("x", no_picture, outline_of("small"), 0.001, 0.0, np.zeros(2))
