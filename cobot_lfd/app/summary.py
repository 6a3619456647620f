"""The summary of an evaluation: how often it went well, what went wrong, how exact and how fast it was."""

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np

from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.errors import DataError
from cobot_lfd.outcome import Outcome

Z_95 = 1.959963984540054
"""The normal distribution's 97.5 % quantile."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """How a number of episodes went.

    Attributes:
        episodes: Number of episodes.
        successes: Number of those that succeeded.
        success_interval: Wilson's 95 % confidence interval of the success rate, (low, high) in 0..1.
        outcomes: Number of episodes by kind of outcome, the most frequent first.
        median_position_error: Of all objects seen [m]; None if none was seen.
        median_angle_error: Of all objects seen [rad]; None if none was seen.
        median_duration: Of the arm's motion [s]; None if there was none.
        median_times: Time that the program needed, by stage [s].
    """

    episodes: int
    successes: int
    success_interval: tuple[float, float]
    outcomes: Mapping[str, int]
    median_position_error: float | None
    median_angle_error: float | None
    median_duration: float | None
    median_times: Mapping[str, float]

    @classmethod
    def of(cls, results: Sequence[EpisodeResult]) -> "Summary":
        """Summarise results, whatever their order.

        Raises:
            DataError: If there is no result.
        """
        if not results:
            raise DataError("there is no result to summarise; run at least one episode.")
        successes = sum(result.verdict.succeeded for result in results)
        seen = [obj for result in results for obj in result.objects]
        return cls(
            episodes=len(results),
            successes=successes,
            success_interval=wilson_interval(successes, len(results)),
            outcomes=_count_outcomes(results),
            median_position_error=_median(obj.position_error for obj in seen),
            median_angle_error=_median(obj.angle_error for obj in seen),
            median_duration=_median(result.duration for result in results),
            median_times=_median_times(results),
        )

    @property
    def success_rate(self) -> float:
        """Share of the episodes that succeeded, in 0..1."""
        return self.successes / self.episodes

    def to_json(self) -> str:
        """The summary as one JSON object; lengths in m, angles in rad, and both also in mm and degrees."""
        return json.dumps(
            {
                "episodes": self.episodes,
                "successes": self.successes,
                "success_rate": self.success_rate,
                "success_interval_95": list(self.success_interval),
                "outcomes": dict(self.outcomes),
                "median_position_error": self.median_position_error,
                "median_position_error_mm": _scaled(self.median_position_error, 1e3),
                "median_angle_error": self.median_angle_error,
                "median_angle_error_deg": _scaled(self.median_angle_error, 180 / np.pi),
                "median_duration": self.median_duration,
                "median_times": dict(self.median_times),
            },
            indent=2,
            allow_nan=False,
        )

    def to_text(self) -> str:
        """The summary for a person, a few lines."""
        low, high = self.success_interval
        lines = [
            f"{self.successes} of {self.episodes} episodes succeeded: {self.success_rate:.1%} "
            f"(95 % interval {low:.1%} to {high:.1%})"
        ]
        lines += [
            f"  {n} x {kind}: {Outcome.from_kind(kind).value}"
            for kind, n in self.outcomes.items()
            if kind != Outcome.SUCCESS.kind
        ]
        if self.median_position_error is not None and self.median_angle_error is not None:
            lines.append(
                f"median error of the poses seen: {1e3 * self.median_position_error:.2f} mm, "
                f"{np.rad2deg(self.median_angle_error):.2f}°"
            )
        if self.median_duration is not None:
            lines.append(f"median duration of the motion: {self.median_duration:.1f} s")
        if self.median_times:
            stages = ", ".join(f"{stage} {seconds:.2f} s" for stage, seconds in self.median_times.items())
            lines.append(f"median computation per episode: {stages}")
        return "\n".join(lines)


def wilson_interval(successes: int, trials: int, z: float = Z_95) -> tuple[float, float]:
    """Confidence interval of a success rate (Wilson 1927, J. Am. Stat. Assoc. 22, 209-212).

    It holds the rates p for which the observed rate is within ``z`` standard deviations,
    sqrt(p (1 - p) / n), of p.

    Args:
        successes: Number of successes.
        trials: Number of trials, at least 1.
        z: Quantile of the normal distribution; the default gives 95 %.

    Returns:
        Lower and upper end, in 0..1.

    Raises:
        ValueError: If the numbers are no count of successes among trials.
    """
    if trials < 1 or not 0 <= successes <= trials:
        raise ValueError(
            f"{successes} successes in {trials} trials; give 0 <= successes <= trials, trials >= 1."
        )
    rate, shrink = successes / trials, 1 / (1 + z**2 / trials)
    centre = shrink * (rate + z**2 / (2 * trials))
    half = shrink * z * np.sqrt(rate * (1 - rate) / trials + z**2 / (4 * trials**2))
    return max(0.0, float(centre - half)), min(1.0, float(centre + half))


def _count_outcomes(results: Iterable[EpisodeResult]) -> dict[str, int]:
    counts = Counter(result.verdict.outcome.kind for result in results)
    return dict(sorted(counts.items(), key=lambda item: (-item[1], item[0])))


def _median(values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return float(median(known)) if known else None


def _median_times(results: Iterable[EpisodeResult]) -> dict[str, float]:
    by_stage: dict[str, list[float]] = {}
    for result in results:
        for stage, seconds in result.times.items():
            by_stage.setdefault(stage, []).append(seconds)
    return {stage: float(median(seconds)) for stage, seconds in by_stage.items()}


def _scaled(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor
