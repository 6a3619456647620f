"""A tool that gives way like a spring: stiff in some directions, soft in others."""

import numpy as np

from cobot_lfd.arrays import Array

_HEIGHT_STIFFNESS = 4000.0  # [N/m]; the carry stays at its height
_TURN_STIFFNESS = 30.0  # [N m/rad]; the tool stays upright and keeps its yaw
_MOVED_MASS, _MOVED_INERTIA = 4.0, 0.005  # [kg], [kg m²] of an arm as felt at its tool, for the damping
_POSTURE_STIFFNESS, _POSTURE_DAMPING = 10.0, 1.0  # [N m/rad], [N m s/rad] of what does not move the tool


def tool_wrench(planar_stiffness: Array, error: Array, error_rate: Array) -> Array:
    """Force and torque of critically damped springs on a tool, shape (6,).

    Args:
        planar_stiffness: In x and y of the world [N/m], symmetric and positive, shape (2, 2).
        error: Wanted less actual position [m] and rotation [rad] of the tool, shape (6,).
        error_rate: Its rate of change, shape (6,).
    """
    stiffness = np.diag([0.0, 0.0, _HEIGHT_STIFFNESS, *[_TURN_STIFFNESS] * 3])
    stiffness[:2, :2] = planar_stiffness
    mass = np.diag([_MOVED_MASS] * 3 + [_MOVED_INERTIA] * 3)
    damping = 2.0 * _square_root(stiffness) @ np.sqrt(mass)
    return np.asarray(stiffness @ error + damping @ error_rate)


def posture_torques(jacobian: Array, error: Array, error_rate: Array) -> Array:
    """Joint torques [N m], shape (n,), that hold an arm's posture without moving its tool.

    Args:
        jacobian: Of the tool, shape (6, n).
        error: Wanted less actual joint positions [rad], shape (n,).
        error_rate: Its rate of change [rad/s], shape (n,).
    """
    wanted = _POSTURE_STIFFNESS * error + _POSTURE_DAMPING * error_rate
    return np.asarray(wanted - np.linalg.pinv(jacobian) @ (jacobian @ wanted))


def _square_root(matrix: Array) -> Array:
    """Of a symmetric positive matrix."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T)
