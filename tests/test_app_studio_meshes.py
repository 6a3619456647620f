"""The page's meshes: few triangles that look like the robot's many."""

from pathlib import Path
from typing import Any

import numpy as np
import pybullet_data
import pytest
import trimesh
from numpy.testing import assert_allclose
from scipy.spatial import cKDTree

from cobot_lfd.app.studio.meshes import patches_of
from cobot_lfd.arrays import Array

FRANKA = Path(pybullet_data.getDataPath()) / "franka_panda" / "meshes" / "visual"
WHITE = (1.0, 1.0, 1.0)
ORANGE = (1.0, 0.5, 0.0)


def corners(points: Array) -> Array:
    return np.array([points.min(axis=0), points.max(axis=0)])


@pytest.mark.parametrize("name", ["link5.obj", "hand.obj"])
def test_few_triangles_have_the_shape_of_many(name: str) -> None:
    """Points on the page's surface lie on the robot's, and both reach equally far."""
    patches = patches_of(FRANKA / name, WHITE)
    light: Any = trimesh.util.concatenate([trimesh.Trimesh(patch.vertices, patch.faces) for patch in patches])
    whole = trimesh.load_mesh(FRANKA / name)
    assert len(light.faces) < 800 < len(whole.faces)
    ours, theirs = (trimesh.sample.sample_surface(mesh, 20_000, seed=0)[0] for mesh in (light, whole))
    away, _ = cKDTree(theirs).query(ours)
    assert np.quantile(away, 0.95) < 0.003  # [m], of which the distance between samples is 1 mm
    assert_allclose(corners(light.vertices), corners(np.asarray(whole.vertices)), atol=1e-3)  # [m]


def test_every_large_material_keeps_its_colour() -> None:
    """A finger is half grey and half white; of a hand, the little lamps are left out."""
    colours = {patch.colour for patch in patches_of(FRANKA / "finger.obj", WHITE)}
    assert colours == {WHITE, (0.5, 0.5, 0.55)}
    assert len(patches_of(FRANKA / "link6.obj", WHITE)) == 3


def test_a_described_colour_wins_over_the_materials() -> None:
    """As in the pictures of the simulator's camera."""
    assert {patch.colour for patch in patches_of(FRANKA / "finger.obj", ORANGE)} == {ORANGE}


def test_a_small_mesh_stays_as_it_is(tmp_path: Path) -> None:
    """A cube's edges are sharp, so each of its six sides has corners of its own."""
    box = trimesh.creation.box((0.1, 0.2, 0.3))
    box.export(tmp_path / "box.stl")
    [patch] = patches_of(tmp_path / "box.stl", WHITE)
    assert len(patch.faces) == 12
    assert len(patch.vertices) == 24
    assert_allclose(corners(patch.vertices), [[-0.05, -0.1, -0.15], [0.05, 0.1, 0.15]])
