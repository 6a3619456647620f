"""A plot of one demonstration: its path from above, and height, speed and force over time."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.disk import write_file
from cobot_lfd.app.pictures.plot import DEMONSTRATION_COLOUR, FRAME_COLOURS, PATH_COLOUR
from cobot_lfd.errors import CobotError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FILE_KINDS = (".pdf", ".png", ".svg")


def plot_episode(episode: RecordedEpisode, file: Path) -> Path:
    """Plot a demonstration and return the file.

    Args:
        episode: What is plotted.
        file: Where the plot goes; its ending chooses PNG, SVG or PDF.

    Raises:
        CobotError: If the file's ending is unknown or it cannot be written.
    """
    if file.suffix.lower() not in _FILE_KINDS:
        raise CobotError(f"cannot plot to {file}: its name must end in one of: {', '.join(_FILE_KINDS)}.")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 6.0), layout="constrained")
    figure.suptitle(f"{episode.scene}, seed {episode.seed}: {episode.verdict.sentence}")
    grid = figure.add_gridspec(3, 2, width_ratios=(1.2, 1.0))
    _plot_path(figure.add_subplot(grid[:, 0]), episode)
    speed = np.linalg.norm(np.gradient(episode.tool_positions, episode.times, axis=0), axis=1)
    force = np.linalg.norm(episode.hand_forces, axis=1)
    series = {
        "height [m]": episode.tool_positions[:, 2],
        "speed [m/s]": speed,
        "force of the hand [N]": force,
    }
    for row, (name, values) in enumerate(series.items()):
        axes = figure.add_subplot(grid[row, 1])
        axes.plot(episode.times, values, color=DEMONSTRATION_COLOUR)
        axes.plot(episode.times, np.where(episode.carrying, values, np.nan), color=PATH_COLOUR)
        axes.set(ylabel=name, xlabel="time [s]" if row == 2 else "")
        axes.grid(visible=True, linewidth=0.4, alpha=0.5)
    buffer = io.BytesIO()
    figure.savefig(buffer, format=file.suffix[1:].lower(), dpi=120)
    write_file(file, buffer.getvalue())
    return file


def _plot_path(axes: Axes, episode: RecordedEpisode) -> None:
    axes.plot(*episode.tool_positions[:, :2].T, color=DEMONSTRATION_COLOUR, label="the whole motion")
    axes.plot(*episode.tool_positions[episode.carrying, :2].T, color=PATH_COLOUR, label="the carry")
    for seen, colour in zip(episode.detections, FRAME_COLOURS * len(episode.detections), strict=False):
        tip = seen.frame.apply([0.05, 0.0])
        axes.plot(*np.stack([seen.frame.position, tip]).T, color=colour, linewidth=2.5)
        axes.plot(*seen.frame.position, "s", color=colour, label=f"{seen.name} (its x axis)")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.grid(visible=True, linewidth=0.4, alpha=0.5)
    axes.legend(frameon=False)
