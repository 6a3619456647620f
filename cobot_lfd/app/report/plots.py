"""Plots of a report, as SVG that stands in the page itself."""

import io
import re
from collections.abc import Sequence
from statistics import median
from typing import TYPE_CHECKING, Any

from cobot_lfd.app.report.cells import Cell
from cobot_lfd.app.results import EpisodeResult

if TYPE_CHECKING:
    from matplotlib.figure import Figure

AXIS_LABELS = {
    "detection_noise_mm": "noise of the seen position [mm]",
    "detection_noise_deg": "noise of the seen angle [°]",
    "camera_noise": "noise of the camera's pixels [of 255]",
    "camera_blur": "blur of the lens [px]",
    "light": "brightness of the lamp [factor]",
    "light_turn_deg": "turn of the lamp [°]",
    "distractors": "distractors [number]",
    "friction": "friction [factor]",
    "range": "ranges of the objects' places [factor]",
    "demonstrations": "demonstrations learnt from [number]",
}
_UNCHANGED = {"light": 1.0, "friction": 1.0, "range": 1.0}
_COLOURS = ("#0b6bcb", "#d1622b", "#2b8a3e", "#8a3ffc", "#b3005e", "#5c6770", "#a08000", "#008080")


def success_plots(cells: Sequence[Cell]) -> list[str]:
    """Success over each perturbation that takes several values while the others stay as they are."""
    names = dict.fromkeys(name for cell in cells for name, _ in cell.condition.perturbation)
    return [plot for name in names for plot in [_success_over(name, cells)] if plot]


def times_plot(results: Sequence[EpisodeResult]) -> str | None:
    """Median time that the program needs for each stage of an episode; None if no time is known."""
    stages: dict[str, list[float]] = {}
    for result in results:
        for stage, seconds in result.times.items():
            stages.setdefault(stage, []).append(seconds)
    if not stages:
        return None
    figure, axes = _figure(0.45 * len(stages) + 1.0)
    medians = {stage: median(values) for stage, values in stages.items()}
    bars = axes.barh(list(medians), list(medians.values()), color=_COLOURS[0], height=0.6)
    axes.bar_label(bars, fmt="%.2f s", padding=3)
    axes.invert_yaxis()
    axes.margins(x=0.15)
    axes.set_xlabel("median computation time per episode [s]")
    return _svg(figure, "Median computation time per stage")


def _success_over(name: str, cells: Sequence[Cell]) -> str | None:
    """Success with its 95 % interval over one perturbation, a line per contender, scene and robot."""
    lines: dict[tuple[str, str, str], list[tuple[float, Cell]]] = {}
    for cell in cells:
        values = dict(cell.condition.perturbation)
        value = values.pop(name, _UNCHANGED.get(name, 0.0))
        if not values and isinstance(value, int | float) and name in AXIS_LABELS:
            key = (cell.condition.contender, cell.condition.scene, cell.condition.robot)
            lines.setdefault(key, []).append((float(value), cell))
    if not any(len(points) > 1 for points in lines.values()):
        return None
    figure, axes = _figure(3.4)
    several = len({key[1:] for key in lines}) > 1
    tried = [value for points in lines.values() for value, _ in points]
    width = max(tried) - min(tried)
    for i, (key, points) in enumerate(lines.items()):
        points.sort(key=lambda point: point[0])
        rates = [100 * cell.rate for _, cell in points]
        low = [max(0.0, 100 * (cell.rate - cell.interval[0])) for _, cell in points]
        high = [max(0.0, 100 * (cell.interval[1] - cell.rate)) for _, cell in points]
        label = ", ".join(key) if several else key[0]
        aside = (i - 0.5 * (len(lines) - 1)) * 0.008 * width  # so that intervals do not hide one another
        at, colour = [value + aside for value, _ in points], _COLOURS[i % len(_COLOURS)]
        axes.errorbar(at, rates, yerr=[low, high], marker="o", capsize=4, label=label, color=colour)
    axes.set_ylim(-4, 104)
    axes.set_xlabel(AXIS_LABELS[name])
    axes.set_ylabel("success [%], 95 % interval")
    axes.legend(frameon=False, fontsize=9)
    return _svg(figure, f"Success over {AXIS_LABELS[name]}")


def _figure(height: float) -> tuple["Figure", Any]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, height), layout="constrained")
    axes = figure.subplots()
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(alpha=0.25)
    return figure, axes


def _svg(figure: "Figure", title: str) -> str:
    """The figure as an SVG element that fills its place and says what it is."""
    from matplotlib import rc_context

    stream = io.StringIO()
    with rc_context({"svg.fonttype": "path", "svg.hashsalt": title}):
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    text = text[text.index("<svg") :]
    return re.sub(r'width="[^"]*pt" height="[^"]*pt"', f'role="img" aria-label="{title}"', text, count=1)
