"""Planar frames: a group of motions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from cobot_lfd.frame import Frame, wrap_angle

numbers = st.floats(-10, 10)
frames = st.builds(lambda x, y, angle: Frame(np.array([x, y]), angle), numbers, numbers, numbers)
POINTS = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, -0.7]])


@given(frames)
def test_a_frame_undone_is_the_identity(frame: Frame) -> None:
    unit = frame.inverse() @ frame
    assert_allclose(unit.position, 0, atol=1e-12)
    assert abs(np.sin(unit.angle)) < 1e-12
    assert np.cos(unit.angle) > 0


@given(frames, frames)
def test_chaining_frames_chains_their_motions(a: Frame, b: Frame) -> None:
    assert_allclose((a @ b).apply(POINTS), a.apply(b.apply(POINTS)), atol=1e-12)


@given(frames)
def test_localise_undoes_apply(frame: Frame) -> None:
    assert_allclose(frame.localise(frame.apply(POINTS)), POINTS, atol=1e-12)


@given(st.floats(-100, 100))
def test_wrapped_angles_point_the_same_way(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -np.pi < wrapped <= np.pi
    assert_allclose([np.cos(wrapped), np.sin(wrapped)], [np.cos(angle), np.sin(angle)], atol=1e-12)


def test_a_frame_without_a_finite_angle_is_refused() -> None:
    with pytest.raises(ValueError, match="angle is nan"):
        Frame(np.zeros(2), float("nan"))


def test_a_frame_with_three_coordinates_is_refused() -> None:
    with pytest.raises(ValueError, match=r"position has shape \(3,\)"):
        Frame(np.zeros(3), 0.0)
