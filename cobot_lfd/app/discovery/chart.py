"""How left-out demonstrations are predicted with each candidate frame and without it, as a chart.

Matplotlib is imported when something is drawn, because it takes longer to import than all the rest.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from cobot_lfd.app.discovery.decisions import Decision, Fate
from cobot_lfd.app.discovery.discover import Discovery

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_chart(axes: Axes, discovery: Discovery, colours: Mapping[str, str]) -> None:
    """For each candidate how left-out demonstrations are predicted with it and without it."""
    decisions = discovery.decisions
    labelled = set()
    for row, decision in enumerate(decisions):
        verdict = discovery.choice.verdicts.get(decision.name)
        comparison = verdict.comparison if verdict is not None else None
        colour = colours[decision.name]
        if comparison is None:
            axes.text(0.02, row, _short(decision), color=colour, fontsize=9, verticalalignment="center",
                      transform=axes.get_yaxis_transform())  # fmt: skip
            continue
        for errors, offset, marker in ((comparison.without, -0.14, "x"), (comparison.with_it, 0.14, "o")):
            label = "without the frame" if marker == "x" else "with it"
            axes.plot(
                1e3 * errors,
                np.full(len(errors), row + offset),
                marker,
                color=colour,
                alpha=0.55,
                markersize=5,
                label=None if label in labelled else f"{label}, each left-out demonstration",
            )
            labelled.add(label)
            axes.plot(
                1e3 * errors.mean(), row + offset, "|", color=colour, markersize=13, markeredgewidth=2.2
            )
    axes.set(
        title="distance of each left-out demonstration from what the others predict; the bars are the means",
        xlabel="[mm]",
        xscale="log",
        yticks=range(len(decisions)),
        yticklabels=[f"{item.name}: {item.fate.value}" for item in decisions],
        ylim=(len(decisions) - 0.5, -0.6),
    )
    axes.title.set_fontsize(10)
    for tick, decision in zip(axes.get_yticklabels(), decisions, strict=True):
        tick.set_color(colours[decision.name])
        tick.set_fontweight("bold" if decision.fate is Fate.KEPT else "normal")
    for axis in (axes.xaxis.set_major_formatter, axes.xaxis.set_minor_formatter):
        axis(_millimetres)
    axes.grid(visible=True, axis="x", which="both", linewidth=0.4, alpha=0.5)
    if labelled:
        axes.legend(loc="lower right", fontsize=8)


def _millimetres(value: float, _place: float) -> str:
    """A label where there is room for one: at 1, 2 and 5 times a power of ten."""
    return f"{value:g}" if f"{value:e}"[0] in "125" else ""


def _short(decision: Decision) -> str:
    return decision.reason if len(decision.reason) < 130 else decision.reason[:127] + "..."
