"""A plot of what was shown and of what was learnt from it.

Matplotlib is imported when something is plotted, because it takes longer to import than all the rest.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cobot_lfd.app.disk import require_folder, write_file
from cobot_lfd.arrays import Array
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import CobotError
from cobot_lfd.frame import Frame, FrameKind
from cobot_lfd.learning.path import GeneratedPath

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

FRAME_COLOURS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""Colours that colour-blind people tell apart too (Okabe and Ito 2008)."""

DEMONSTRATION_COLOUR, PATH_COLOUR, COVARIANCE_COLOUR = "#8A8A8A", "#000000", "#56B4E9"

_FILE_KINDS = (".pdf", ".png", ".svg")
_N_ELLIPSES = 24
_IDENTITY = Frame(np.zeros(2), 0.0)


def plot_model(
    demonstrations: Sequence[Demonstration],
    frames: Mapping[str, Frame],
    path: GeneratedPath,
    *,
    file: Path,
    kinds: Mapping[str, FrameKind] | None = None,
    title: str = "",
) -> Path:
    """Plot the demonstrations, in the world and as each frame sees them, and the path for a new scene.

    Args:
        demonstrations: What was learnt from; empty to plot the path alone.
        frames: The new scene's frames.
        path: The planar path that was generated for it, with its covariance.
        file: Where the plot goes; its ending chooses PNG, SVG or PDF.
        kinds: Whether each frame was found to be oriented; None to leave it out.
        title: Headline; empty for none.

    Returns:
        The file.

    Raises:
        CobotError: If the file's ending is unknown or it cannot be written.
    """
    require_plot_file(file)
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 7.0) if demonstrations else (7.5, 7.0), layout="constrained")
    if title:
        figure.suptitle(title)
    colours = dict(zip(frames, FRAME_COLOURS * len(frames), strict=False))
    columns = figure.add_gridspec(1, 2, width_ratios=(1.0, 1.15))
    if demonstrations:
        _plot_demonstrations(figure.add_subfigure(columns[0]), demonstrations, colours, kinds or {})
    right = figure.add_subfigure(columns[1] if demonstrations else columns[:])
    _plot_generated(right.subplots(), frames, path, colours)
    right.legend(loc="outside lower center", ncols=3 if demonstrations else 2, frameon=False)
    return save_figure(figure, file)


def _plot_demonstrations(
    figure: SubFigure,
    demonstrations: Sequence[Demonstration],
    colours: Mapping[str, str],
    kinds: Mapping[str, FrameKind],
) -> None:
    """The demonstrations in the world above, and below as each frame sees them."""
    grid = figure.add_gridspec(2, len(colours), height_ratios=(1.3, 1.0))
    _plot_world(figure.add_subplot(grid[0, :]), demonstrations, colours)
    for column, (name, colour) in enumerate(colours.items()):
        kind = f"\n({kinds[name].value})" if name in kinds else ""
        _plot_local(figure.add_subplot(grid[1, column]), demonstrations, name, colour, kind)


def _plot_world(axes: Axes, demonstrations: Sequence[Demonstration], colours: Mapping[str, str]) -> None:
    """The demonstrations where they were recorded, with the frames of each."""
    for demonstration in demonstrations:
        axes.plot(*demonstration.path.T, color=DEMONSTRATION_COLOUR, linewidth=1.0)
        for name, colour in colours.items():
            _plot_frame(axes, demonstration.frames[name], colour, length=0.03)
    _finish(axes, f"{len(demonstrations)} demonstrations in the world")


def _plot_local(
    axes: Axes, demonstrations: Sequence[Demonstration], name: str, colour: str, kind: str
) -> None:
    """The demonstrations as a frame sees them; where they agree, the frame matters (paper, eq. 1)."""
    for demonstration in demonstrations:
        local = demonstration.frames[name].localise(demonstration.path)
        axes.plot(*local.T, color=DEMONSTRATION_COLOUR, linewidth=1.0)
    _plot_frame(axes, _IDENTITY, colour, length=0.06)
    _finish(axes, f"seen from the {name}{kind}")


def _plot_generated(
    axes: Axes, frames: Mapping[str, Frame], path: GeneratedPath, colours: Mapping[str, str]
) -> None:
    """The new scene: frames, path and covariance."""
    from matplotlib.patches import Ellipse

    chosen = np.unique(np.linspace(0, len(path.mean) - 1, _N_ELLIPSES).round().astype(int))
    for index in chosen:
        width, height, degrees = ellipse_axes(path.covariance[index])
        axes.add_patch(
            Ellipse(
                (path.mean[index, 0], path.mean[index, 1]),
                width,
                height,
                angle=degrees,
                facecolor=(COVARIANCE_COLOUR, 0.12),
                edgecolor=(COVARIANCE_COLOUR, 0.7),
                linewidth=0.8,
                label="covariance (2 std. deviations)" if index == chosen[0] else None,
            )
        )
    axes.plot(*path.mean.T, color=PATH_COLOUR, linewidth=2.0, label="generated path")
    axes.plot(
        *path.mean[0],
        "o",
        color=PATH_COLOUR,
        fillstyle="none",
        markersize=11,
        markeredgewidth=1.5,
        label="its start",
    )
    for name, colour in colours.items():
        _plot_frame(axes, frames[name], colour, length=0.05, label=name)
    _finish(axes, "the path generated for a new scene")


def ellipse_axes(covariance: Array) -> tuple[float, float, float]:
    """The ellipse at 2 standard deviations: both diameters [m] and the direction of the first [degrees]."""
    variances, directions = np.linalg.eigh(covariance)
    diameters = 4.0 * np.sqrt(np.maximum(variances, 0.0))
    degrees = np.rad2deg(np.arctan2(directions[1, 1], directions[0, 1]))
    return float(diameters[1]), float(diameters[0]), float(degrees)


def _plot_frame(axes: Axes, frame: Frame, colour: str, *, length: float, label: str | None = None) -> None:
    """A frame's origin and axes; the x axis is drawn solid and thick, the y axis thin."""
    for axis, width in ((0, 2.5), (1, 1.0)):
        tip = frame.position + length * frame.rotation[:, axis]
        axes.plot(*np.stack([frame.position, tip]).T, color=colour, linewidth=width)
    name = None if label is None else f"{label} (x axis thick)"
    axes.plot(*frame.position, "s", color=colour, markersize=4.5, label=name)


def _finish(axes: Axes, title: str) -> None:
    axes.set(title=title, xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.grid(visible=True, linewidth=0.4, alpha=0.5)


def require_plot_file(file: Path) -> None:
    """Refuse a file that no plot can be written to.

    Raises:
        CobotError: If its ending is unknown, or there is no such folder.
    """
    if file.suffix.lower() not in _FILE_KINDS:
        raise CobotError(f"cannot plot to {file}: its name must end in one of: {', '.join(_FILE_KINDS)}.")
    require_folder(file)


def save_figure(figure: Figure, file: Path) -> Path:
    """Write a figure, whole or not at all, and return its file.

    Raises:
        CobotError: If it cannot be written.
    """
    buffer = io.BytesIO()
    figure.savefig(buffer, format=file.suffix[1:].lower(), dpi=120)
    write_file(file, buffer.getvalue())
    return file
