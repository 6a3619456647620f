"""A region is compared with an object's image at all angles: the right one is among the likeliest."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame, wrap_angle
from perception.coarse_pose import Comparison
from perception.region import Region
from perception.silhouette import silhouette_hull
from tests.perception_examples import CAMERA, MODELS

PLACES = np.random.default_rng(0).uniform([0.35, -0.2, -np.pi], [0.6, 0.2, np.pi], (20, 3))
POSES = [Frame(place[:2], place[2]) for place in PLACES]


def image_of(model: ObjectModel, frame: Frame) -> Region:
    """All of an object's image as a region."""
    hull = silhouette_hull(model, frame, CAMERA)
    area = cv2.contourArea(hull.astype(np.float32))
    return Region(hull, hull.mean(axis=0), area, model.colour, at_border=False)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
@pytest.mark.parametrize("frame", POSES, ids=lambda frame: f"{frame.angle:.2f}")
def test_an_objects_own_image_leads_to_its_pose_and_is_not_too_wide(model: ObjectModel, frame: Frame) -> None:
    comparison = Comparison.of(image_of(model, frame), model, CAMERA, 1)
    best = comparison.poses()[0]
    assert np.linalg.norm(best.position - frame.position) < 0.005
    assert abs(wrap_angle(model.symmetry * (best.angle - frame.angle))) < model.symmetry * np.deg2rad(5.0)
    assert comparison.too_wide < 1.0


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
@pytest.mark.parametrize("frame", POSES, ids=lambda frame: f"{frame.angle:.2f}")
def test_what_is_twice_as_long_is_too_wide(model: ObjectModel, frame: Frame) -> None:
    longer = replace(model, outline=model.outline * [2.0, 1.0])
    comparison = Comparison.of(image_of(longer, frame), model, CAMERA, 1)
    assert comparison.too_wide > 3.0
