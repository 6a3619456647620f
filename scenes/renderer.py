"""What draws pictures, made ready; where it does not work, what the machine lacks for it."""

import ctypes
import importlib.util
import subprocess
import sys
from functools import cache
from typing import Literal

import pybullet
from pybullet_utils.bullet_client import BulletClient

from cobot_lfd.errors import CobotError

Renderer = Literal["tiny", "egl"]
"""What draws: PyBullet's own software, or OpenGL by way of EGL."""

_LIBRARIES = {"libEGL.so.1": "libegl1", "libGL.so.1": "libgl1"}
"""What PyBullet's plugin loads, with the Debian packages that hold it."""

_DRIVERS = "libegl-mesa0 libgl1-mesa-dri"
"""The Debian packages with Mesa's part of EGL and its drivers, of which one needs no graphics card."""


def load_renderer(client: BulletClient, renderer: Renderer) -> int | None:
    """Make a renderer ready, before anything is built; returns the plugin's number, if it needs one.

    Raises:
        CobotError: If OpenGL does not work here.
    """
    if renderer == "tiny":
        return None
    if not egl_works():
        raise CobotError(
            f"the renderer 'egl' does not start on this machine: {_what_egl_lacks()} "
            "Or use the renderer 'tiny', which needs nothing."
        )
    return _load_egl(client)


@cache
def egl_works() -> bool:
    """Whether OpenGL by way of EGL works here.

    It is tried in a process of its own: where a library is missing, PyBullet's plugin ends the process.
    """
    probe = "from scenes.renderer import draw_with_egl; draw_with_egl()"
    return subprocess.run([sys.executable, "-c", probe], capture_output=True, check=False).returncode == 0


def _what_egl_lacks() -> str:
    """Which library is missing, and the Debian packages that hold it."""
    for library, package in _LIBRARIES.items():
        try:
            ctypes.CDLL(library)
        except OSError:
            return f"{library} cannot be loaded. On Debian or Ubuntu: apt install {package} {_DRIVERS}."
    return f"EGL finds no driver. On Debian or Ubuntu: apt install {_DRIVERS}."


def draw_with_egl() -> None:
    """Draw a small picture of nothing by way of EGL; ends the process where that does not work."""
    client = BulletClient(pybullet.DIRECT)
    if _load_egl(client) < 0:
        sys.exit(1)
    client.getCameraImage(16, 16, renderer=pybullet.ER_BULLET_HARDWARE_OPENGL)


def _load_egl(client: BulletClient) -> int:
    """Load the plugin that ships with PyBullet; returns its number, negative where there is none."""
    found = importlib.util.find_spec("eglRenderer")
    return int(client.loadPlugin(found.origin, "_eglRendererPlugin")) if found and found.origin else -1
