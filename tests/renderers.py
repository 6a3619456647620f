"""The renderers that tests draw with: one needs OpenGL, which not every machine has."""

import pytest

from scenes.renderer import egl_works

needs_egl = pytest.mark.skipif(not egl_works(), reason="OpenGL by way of EGL does not work on this machine")
RENDERERS = ("tiny", pytest.param("egl", marks=needs_egl))
