"""Results counted by condition: every contender in every scene with every robot under every perturbation."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.summary import wilson_interval

SHOWN_METRICS = ("d_total", "d_start", "d_end", "sharp_edges", "efficiency", "reachability")
"""Measures of the paths that reports show."""


@dataclass(frozen=True, slots=True, order=True)
class Condition:
    """What the episodes of a cell have in common.

    Attributes:
        contender: Model or method.
        scene: Name of the scene.
        robot: Name of the robot.
        perturbation: What was made harder, as pairs of name and value.
    """

    contender: str
    scene: str
    robot: str
    perturbation: tuple[tuple[str, float | str], ...] = ()

    @property
    def perturbed(self) -> str:
        """What was made harder, in words; "none" where nothing was."""
        return ", ".join(_in_words(name, value) for name, value in self.perturbation) or "none"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """How the episodes of one condition went.

    Attributes:
        condition: What they have in common.
        episodes: How many there are.
        successes: How many succeeded.
        interval: Wilson's 95 % interval of the success rate, in 0..1.
        metrics: Medians of the paths' measures by name; those that no episode had are left out.
        duration: Median duration of the motion [s]; None if there was none.
    """

    condition: Condition
    episodes: int
    successes: int
    interval: tuple[float, float]
    metrics: Mapping[str, float]
    duration: float | None

    @property
    def rate(self) -> float:
        """Share of the episodes that succeeded, in 0..1."""
        return self.successes / self.episodes


def condition_of(result: EpisodeResult) -> Condition:
    """The condition of an episode."""
    contender = result.contender or result.method
    return Condition(contender, result.scene, result.robot, tuple(sorted(result.perturbation.items())))


def cells_of(results: Iterable[EpisodeResult]) -> list[Cell]:
    """A cell for each condition, in the order in which the conditions first appear."""
    groups: dict[Condition, list[EpisodeResult]] = {}
    for result in results:
        groups.setdefault(condition_of(result), []).append(result)
    return [_cell(condition, group) for condition, group in groups.items()]


def cells_text(cells: Sequence[Cell]) -> str:
    """A line per cell, for a terminal."""
    lines = []
    for cell in cells:
        c, (low, high) = cell.condition, cell.interval
        where = f"{c.contender}, {c.scene}, {c.robot}, perturbation {c.perturbed}"
        lines.append(
            f"  {where}: {cell.successes} of {cell.episodes} ({cell.rate:.1%}; 95 % {low:.1%} to {high:.1%})"
        )
    return "\n".join(lines)


def _in_words(name: str, value: float | str) -> str:
    """A perturbation for people: "detection noise 8 mm"."""
    if value is True:
        return name
    if isinstance(value, str):
        return f"{name.replace('_', ' ')} {value.replace('_', ' ')}"
    units = {"_mm": " mm", "_deg": "°"}
    ending = next((ending for ending in units if name.endswith(ending)), "")
    return f"{name.removesuffix(ending).replace('_', ' ')} {value:g}{units.get(ending, '')}"


def _cell(condition: Condition, group: Sequence[EpisodeResult]) -> Cell:
    successes = sum(result.verdict.succeeded for result in group)
    durations = [result.duration for result in group if result.duration is not None]
    metrics = {}
    for name in SHOWN_METRICS:
        values = [result.metrics[name] for result in group if name in result.metrics]
        if values:
            metrics[name] = float(median(values))
    return Cell(
        condition=condition,
        episodes=len(group),
        successes=successes,
        interval=wilson_interval(successes, len(group)),
        metrics=metrics,
        duration=float(median(durations)) if durations else None,
    )
