"""What was found out about the candidate frames, as a picture: a panel per demonstration, and a chart.

Matplotlib is imported when something is drawn, because it takes longer to import than all the rest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.discovery.chart import draw_chart
from cobot_lfd.app.discovery.decisions import Decision, Fate
from cobot_lfd.app.discovery.discover import Discovery
from cobot_lfd.app.pictures.plot import require_plot_file, save_figure
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_N_COLUMNS = 3
_ROW_HEIGHT = 3.75  # [inch] of a picture with its title
_PAD = 0.1  # [inch] around each panel, or the topmost titles are cut
_BASE = "#555555"  # It has no colour of its own in the pictures.
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # Of red, green and blue (ITU-R BT.709).
_MOST_LUMINANCE = 0.45  # Of lines and names on white.
_PATH = "#111111"
_MARGIN = 14  # [px] between an outline and its name
_LETTER = 5.2  # Half the width of a letter [px].


def draw_discovery(
    discovery: Discovery, episodes: Sequence[RecordedEpisode], camera: Camera, file: Path
) -> Path:
    """Draw what was found.

    Args:
        discovery: What was found.
        episodes: The demonstrations in which it was found.
        camera: Their camera.
        file: Where the picture goes; its ending chooses PNG, SVG or PDF.

    Raises:
        CobotError: If the file's ending is unknown or it cannot be written.
    """
    require_plot_file(file)
    from matplotlib.figure import Figure

    n_rows = -(-len(episodes) // _N_COLUMNS)
    heights = (_ROW_HEIGHT * n_rows, 0.42 * len(discovery.decisions) + 1.2)
    figure = Figure(figsize=(13.0, sum(heights)))
    figure.set_layout_engine("constrained", h_pad=_PAD, w_pad=_PAD)
    grid = figure.add_gridspec(2, 1, height_ratios=heights)
    above, below = (figure.add_subfigure(grid[row]) for row in range(2))
    colours = _colours(discovery)
    panels = above.subplots(n_rows, _N_COLUMNS, squeeze=False).ravel()
    for n, (axes, episode) in enumerate(zip(panels, episodes, strict=False)):
        _draw_demonstration(axes, discovery, n, episode, camera, colours)
    for axes in panels[len(episodes) :]:
        axes.axis("off")
    draw_chart(below.subplots(), discovery, colours)
    return save_figure(figure, file)


def _colours(discovery: Discovery) -> dict[str, str]:
    """Each candidate's own colour, darkened where it could not be read on white."""
    models = discovery.candidates.models
    return {
        name: _legible(models[name].colour) if name in models else _BASE
        for name in discovery.candidates.tracks
    }


def _legible(colour: Array) -> str:
    luminance = float(colour @ _LUMINANCE)
    red, green, blue = np.rint(255 * colour * min(1.0, _MOST_LUMINANCE / max(luminance, 1e-9))).astype(int)
    return f"#{red:02x}{green:02x}{blue:02x}"


def _draw_demonstration(
    axes: Axes,
    discovery: Discovery,
    n: int,
    episode: RecordedEpisode,
    camera: Camera,
    colours: Mapping[str, str],
) -> None:
    """One picture with its candidates and the way that the tool went."""
    axes.imshow(episode.picture)
    above_table = episode.tool_positions[episode.carrying] * [1.0, 1.0, 0.0]
    carried = camera.project(above_table)
    axes.plot(*carried.T, color="white", linewidth=3.4)
    axes.plot(*carried.T, color=_PATH, linewidth=1.6)
    axes.plot(*carried[0], "o", color=_PATH, markeredgecolor="white", markersize=5)
    for decision in discovery.decisions:
        seen = discovery.candidates.tracks[decision.name].sightings[n]
        if isinstance(seen, Detection) and len(seen.contour):
            _draw_candidate(axes, decision, seen, discovery, camera, colours[decision.name])
    axes.set(
        title=f"demonstration {n + 1} (seed {episode.seed}): "
        f"{1e3 * discovery.choice.errors[n]:.0f} mm when left out",
        xlim=(-0.5, camera.width - 0.5),
        ylim=(camera.height - 0.5, -0.5),
        xticks=[],
        yticks=[],
    )
    axes.title.set_fontsize(10)


def _draw_candidate(
    axes: Axes, decision: Decision, seen: Detection, discovery: Discovery, camera: Camera, colour: str
) -> None:
    from matplotlib.patheffects import withStroke

    kept = decision.fate is Fate.KEPT
    style = {Fate.KEPT: "-", Fate.MERGED: "--", Fate.DROPPED: ":"}[decision.fate]
    outline = np.vstack([seen.contour, seen.contour[:1]])
    rim = [withStroke(linewidth=4.0 if kept else 2.6, foreground="white")]
    axes.plot(*outline.T, style, color=colour, linewidth=2.2 if kept else 1.2, path_effects=rim)
    model = discovery.candidates.models[decision.name]
    if kept:
        length = 0.7 * float(np.linalg.norm(model.outline, axis=1).max())
        for axis, width in ((0, 2.5), (1, 1.2)):
            ends = np.stack(
                [seen.frame.position, seen.frame.position + length * seen.frame.rotation[:, axis]]
            )
            drawn = camera.project(np.column_stack([ends, np.full(2, model.z)]))
            axes.plot(*drawn.T, color=colour, linewidth=width, path_effects=rim)
    name = decision.name if kept else f"{decision.name} ({decision.fate.value})"
    half = _LETTER * len(name)
    low, high = outline.min(axis=0), outline.max(axis=0)
    below = high[1] + 2 * _MARGIN < camera.height
    axes.text(
        float(np.clip(0.5 * (low[0] + high[0]), half, camera.width - half)),
        float(high[1] + _MARGIN if below else low[1] - _MARGIN),
        name,
        color=colour,
        fontsize=10 if kept else 8,
        fontweight="bold" if kept else "normal",
        horizontalalignment="center",
        verticalalignment="center",
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
    )
