"""Planar learning and motion for a cobot, as plain values and functions."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cobot_lfd.demonstration import Demonstration as Demonstration
    from cobot_lfd.demonstration import SpatialDemonstration as SpatialDemonstration
    from cobot_lfd.frame import Frame as Frame
    from cobot_lfd.frame import FrameKind as FrameKind
    from cobot_lfd.learning.model import TaskParameterisedGMM as TaskParameterisedGMM
    from cobot_lfd.learning.path import GeneratedPath as GeneratedPath
    from cobot_lfd.method import Method as Method
    from cobot_lfd.method import Reproducer as Reproducer
    from cobot_lfd.pose import Pose as Pose

_HOMES = {
    "Demonstration": "cobot_lfd.demonstration",
    "Frame": "cobot_lfd.frame",
    "FrameKind": "cobot_lfd.frame",
    "GeneratedPath": "cobot_lfd.learning.path",
    "Method": "cobot_lfd.method",
    "Pose": "cobot_lfd.pose",
    "Reproducer": "cobot_lfd.method",
    "SpatialDemonstration": "cobot_lfd.demonstration",
    "TaskParameterisedGMM": "cobot_lfd.learning.model",
}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for, so that ``import cobot_lfd`` stays cheap."""
    if name not in _HOMES:
        raise AttributeError(f"module 'cobot_lfd' has no attribute '{name}'")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """The public names."""
    return list(__all__)
