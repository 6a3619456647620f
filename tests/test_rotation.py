"""Rotation vectors, against SciPy's."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from cobot_lfd.rotation import rotation_matrix, rotation_vector

directions = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)
angles = st.one_of(st.floats(0.0, np.pi), st.floats(0.0, 1e-6), st.floats(np.pi - 1e-4, np.pi))


@given(directions, angles)
def test_a_rotation_is_the_one_that_scipy_knows(direction: tuple[float, ...], angle: float) -> None:
    vector = angle * np.array(direction) / np.linalg.norm(direction)
    theirs = Rotation.from_rotvec(vector)
    assert_allclose(rotation_matrix(vector), theirs.as_matrix(), atol=1e-12)
    back = rotation_vector(theirs.as_matrix())
    assert_allclose(rotation_matrix(back), theirs.as_matrix(), atol=1e-9)
    assert np.linalg.norm(back) == pytest.approx(angle, abs=1e-9)


@pytest.mark.parametrize("axis", [[1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [-0.48, 0.6, -0.64]])
def test_half_a_turn_has_its_axis(axis: list[float]) -> None:
    vector = rotation_vector(Rotation.from_rotvec(np.pi * np.array(axis)).as_matrix())
    assert abs(vector @ axis) == pytest.approx(np.pi, abs=1e-9)


def test_no_rotation_is_a_vector_of_length_zero() -> None:
    assert_allclose(rotation_vector(np.eye(3)), np.zeros(3))
    assert_allclose(rotation_matrix(np.zeros(3)), np.eye(3))
