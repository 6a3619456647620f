"""Contenders compared on the same seeds: McNemar's exact test."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from scipy.special import bdtr

from cobot_lfd.app.report.cells import Condition, condition_of
from cobot_lfd.app.results import EpisodeResult


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """Two contenders under the same conditions and on the same seeds.

    Attributes:
        first: Name of the one.
        second: Name of the other.
        where: Scene, robot and perturbation; its contender is empty.
        pairs: Number of seeds that both have.
        both: On how many of them both succeeded.
        only_first: On how many only the first did.
        only_second: On how many only the second did.
        p_value: Probability of a difference at least as large, were both equally good (McNemar's exact test).
    """

    first: str
    second: str
    where: Condition
    pairs: int
    both: int
    only_first: int
    only_second: int
    p_value: float


def comparisons_of(results: Sequence[EpisodeResult]) -> list[Comparison]:
    """Every pair of contenders that share seeds under the same conditions."""
    by_place: dict[Condition, dict[str, dict[int, bool]]] = {}
    for result in results:
        own = condition_of(result)
        where = Condition("", own.scene, own.robot, own.perturbation)
        by_place.setdefault(where, {}).setdefault(own.contender, {})[result.seed] = result.verdict.succeeded
    found = []
    for where, contenders in by_place.items():
        for first, second in combinations(contenders, 2):
            if contenders[first].keys() & contenders[second].keys():
                found.append(_compare(first, second, where, contenders[first], contenders[second]))
    return found


def mcnemar(only_first: int, only_second: int) -> float:
    """P-value of McNemar's exact test: is a disagreement as likely one way as the other?"""
    disagreements = only_first + only_second
    return min(1.0, 2.0 * float(bdtr(min(only_first, only_second), disagreements, 0.5)))


def _compare(
    first: str, second: str, where: Condition, of_first: dict[int, bool], of_second: dict[int, bool]
) -> Comparison:
    pairs = [(of_first[seed], of_second[seed]) for seed in of_first.keys() & of_second.keys()]
    only_first = sum(a and not b for a, b in pairs)
    only_second = sum(b and not a for a, b in pairs)
    return Comparison(
        first=first,
        second=second,
        where=where,
        pairs=len(pairs),
        both=sum(a and b for a, b in pairs),
        only_first=only_first,
        only_second=only_second,
        p_value=mcnemar(only_first, only_second),
    )
