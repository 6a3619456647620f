"""A report as one HTML file that needs no network: tables, plots, and failures to look through."""

from base64 import b64encode
from importlib.resources import files
from pathlib import Path
from typing import Any

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from cobot_lfd.app.report.cells import SHOWN_METRICS
from cobot_lfd.app.report.content import Episode, Report
from cobot_lfd.app.report.plots import success_plots, times_plot

_TEMPLATE = "report.html.j2"
_METRIC_NAMES = {
    "d_total": "d_total [mm]",
    "d_start": "d_start [mm]",
    "d_end": "d_end [mm]",
    "sharp_edges": "sharp edges",
    "efficiency": "efficiency",
    "reachability": "reach [%]",
}


def to_html(report: Report) -> str:
    """The whole report as one page."""
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters |= {"percent": _percent, "metric": _metric}
    template = environment.from_string(files(__package__).joinpath(_TEMPLATE).read_text(encoding="utf-8"))
    results = [episode.result for episode in report.episodes]
    times = times_plot(results)
    return template.render(
        report=report,
        metrics=_METRIC_NAMES,
        shown_metrics=SHOWN_METRICS,
        success_plots=[Markup(plot) for plot in success_plots(report.cells)],
        times_plot=None if times is None else Markup(times),
        perturbations=list(dict.fromkeys(episode.condition.perturbed for episode in report.episodes)),
        scenes=list(dict.fromkeys(episode.condition.scene for episode in report.episodes)),
        kinds=_kinds(report),
        picture=_data_uri,
    )


def _kinds(report: Report) -> dict[str, str]:
    """Kinds of outcomes that occurred, with their sentences."""
    outcomes = dict.fromkeys(episode.result.verdict.outcome for episode in report.episodes)
    return {outcome.kind: outcome.value for outcome in outcomes}


def _data_uri(episode: Episode) -> str:
    return "data:image/webp;base64," + b64encode(_content(episode.picture)).decode()


def _content(file: Path | None) -> bytes:
    return b"" if file is None else file.read_bytes()


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def _metric(value: Any, name: str) -> str:
    """A measure for people: distances in mm."""
    if name.startswith("d_"):
        return f"{1e3 * value:.1f}"
    return f"{value:.3g}"
