"""A report as Markdown."""

from collections.abc import Iterable, Sequence

from cobot_lfd.app.report.cells import SHOWN_METRICS
from cobot_lfd.app.report.content import Report

_MOST_FAILURES = 50


def to_markdown(report: Report) -> str:
    """The report's tables, and the first failures with the commands that run them again."""
    done = len(report.episodes)
    parts = [
        f"# Evaluation: {report.title}",
        f"{done} of {report.planned} planned episodes have ended.",
        "## Success",
        _success(report),
        "## Contenders on the same seeds",
        _comparisons(report),
        "## Outcomes",
        _outcomes(report),
        "## Failures",
        _failures(report),
        "## Where this came from",
        _provenance(report),
    ]
    return "\n\n".join(parts) + "\n"


def _success(report: Report) -> str:
    head = [
        "contender",
        "scene",
        "robot",
        "perturbation",
        "success",
        "95 % interval (Wilson)",
        *SHOWN_METRICS,
    ]
    rows = [
        [
            *(cell.condition.contender, cell.condition.scene, cell.condition.robot, cell.condition.perturbed),
            f"{cell.successes} of {cell.episodes} ({cell.rate:.1%})",
            f"{cell.interval[0]:.1%} to {cell.interval[1]:.1%}",
            *(f"{cell.metrics[name]:.4g}" if name in cell.metrics else "" for name in SHOWN_METRICS),
        ]
        for cell in report.cells
    ]
    note = "Measures are medians; d_total, d_start and d_end in m, reachability in %."
    return f"{_table(head, rows)}\n\n{note}"


def _comparisons(report: Report) -> str:
    if not report.comparisons:
        return "There is only one contender."
    head = ["first", "second", "scene", "perturbation", "seeds", "both", "only first", "only second", "p"]
    rows = [
        [
            *(c.first, c.second, c.where.scene, c.where.perturbed),
            *map(str, (c.pairs, c.both, c.only_first, c.only_second)),
            f"{c.p_value:.3g}",
        ]
        for c in report.comparisons
    ]
    return f"{_table(head, rows)}\n\np: McNemar's exact test."


def _outcomes(report: Report) -> str:
    rows = [[sentence, *map(str, counts.values())] for sentence, counts in report.outcomes.items()]
    return _table(["outcome", *report.contenders], rows)


def _failures(report: Report) -> str:
    lines = [
        f"- {episode.condition.contender}, seed {episode.result.seed}, perturbation "
        f"{episode.condition.perturbed}: {episode.result.verdict.sentence}  \n  `{episode.command}`"
        for episode in report.failures[:_MOST_FAILURES]
    ]
    rest = len(report.failures) - _MOST_FAILURES
    if rest > 0:
        lines.append(f"- and {rest} more; see the HTML report.")
    return "\n".join(lines) or "There are none."


def _provenance(report: Report) -> str:
    rows = [
        [
            name,
            key,
            ", ".join(f"{k} {v}" for k, v in value.items()) if isinstance(value, dict) else str(value),
        ]
        for name, values in report.provenance.items()
        for key, value in values.items()
    ]
    return _table(["run", "what", "value"], rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
