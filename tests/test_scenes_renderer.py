"""Where OpenGL by way of EGL does not work, the message names what is missing and what to install."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.renderers import needs_egl

pytestmark = pytest.mark.simulator


def told(**environment: str) -> str:
    """What is said of the renderer in a process with this environment."""
    run = "from scenes.renderer import load_renderer; load_renderer(None, 'egl')"
    done = subprocess.run(
        [sys.executable, "-c", run],
        env=os.environ | environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    return done.stderr.splitlines()[-1]


def test_a_missing_library_is_named_with_its_package(tmp_path: Path) -> None:
    (tmp_path / "libEGL.so.1").touch()  # Found first, and no library.
    (tmp_path / "libEGL.so").touch()
    line = told(LD_LIBRARY_PATH=str(tmp_path))
    assert "CobotError: the renderer 'egl' does not start on this machine" in line
    assert "libEGL.so.1 cannot be loaded. On Debian or Ubuntu: apt install libegl1 libegl-mesa0" in line
    assert "use the renderer 'tiny'" in line


@needs_egl
def test_a_missing_driver_is_told_from_a_missing_library(tmp_path: Path) -> None:
    line = told(__EGL_VENDOR_LIBRARY_DIRS=str(tmp_path))
    assert "EGL finds no driver. On Debian or Ubuntu: apt install libegl-mesa0 libgl1-mesa-dri." in line
