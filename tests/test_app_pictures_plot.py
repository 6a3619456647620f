"""The plot of the model shows covariances at their true size, in a file that can be opened."""

import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.app.pictures.plot import ellipse_axes, plot_model
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import CobotError
from cobot_lfd.frame import Frame, FrameKind
from cobot_lfd.learning.path import GeneratedPath

N_STEPS = 40
FRAMES = {"cube": Frame(np.array([0.4, 0.1]), 0.3), "container": Frame(np.array([0.6, -0.2]), -2.0)}
LINE = np.linspace(FRAMES["cube"].position, FRAMES["container"].position, N_STEPS)


def generated(sigma: float = 0.02) -> GeneratedPath:
    covariance = np.tile(sigma**2 * np.eye(2), (N_STEPS, 1, 1))
    return GeneratedPath(LINE, covariance, np.linspace(0.0, 3.0, N_STEPS))


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.2])
def test_the_ellipse_lies_at_two_standard_deviations(angle: float) -> None:
    rotation = Frame(np.zeros(2), angle).rotation
    covariance = rotation @ np.diag([0.03**2, 0.01**2]) @ rotation.T
    width, height, degrees = ellipse_axes(covariance)
    assert_allclose((width, height), (4 * 0.03, 4 * 0.01))  # [m]
    assert_allclose(np.sin(np.deg2rad(degrees) - angle), 0.0, atol=1e-9)


def bluish_share(file: Path) -> float:
    """Share of a picture's pixels that are rather blue than red."""
    picture = cv2.imread(str(file))
    assert picture is not None
    blue, _, red = np.moveaxis(picture.astype(int), 2, 0)
    return float((blue > red + 10).mean())


def test_a_larger_covariance_covers_more_of_the_picture(tmp_path: Path) -> None:
    small, large = (
        bluish_share(
            plot_model([Demonstration(LINE, FRAMES)], FRAMES, generated(sigma), file=tmp_path / "plot.png")
        )
        for sigma in (0.002, 0.03)
    )
    assert large > 5 * small


def test_the_plot_names_frames_and_their_kinds(tmp_path: Path) -> None:
    kinds = {"cube": FrameKind.ORIENTATION_LESS, "container": FrameKind.ORIENTED}
    demonstrations = [Demonstration(LINE, FRAMES), Demonstration(LINE + 0.01, FRAMES)]
    file = plot_model(
        demonstrations, FRAMES, generated(), file=tmp_path / "plot.svg", kinds=kinds, title="my scene"
    )
    text = file.read_text()
    for label in (
        "my scene",
        "2 demonstrations",
        "seen from the cube",
        "(orientation-less)",
        "(oriented)",
        "x [m]",
    ):
        assert f"<!-- {label}" in text, label


def test_without_demonstrations_the_path_is_plotted_alone(tmp_path: Path) -> None:
    text = plot_model([], FRAMES, generated(), file=tmp_path / "plot.svg").read_text()
    assert "the path generated" in text
    assert "demonstrations" not in text


def test_another_ending_is_told(tmp_path: Path) -> None:
    with pytest.raises(
        CobotError, match=r"cannot plot to .*plot\.gif: its name must end in one of: \.pdf, \.png"
    ):
        plot_model([Demonstration(LINE, FRAMES)], FRAMES, generated(), file=tmp_path / "plot.gif")


def test_matplotlib_is_imported_only_to_plot() -> None:
    code = "import sys, cobot_lfd.app.pictures.plot; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
