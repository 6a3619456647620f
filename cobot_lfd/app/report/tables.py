"""Reports for programs: every episode as a line of CSV, everything as JSON."""

import csv
import io
import json
from dataclasses import asdict
from typing import Any

from cobot_lfd.app.report.cells import Cell
from cobot_lfd.app.report.content import Report

_PLAIN = ("run", "trial", "seed", "scene", "robot", "method", "contender", "success", "outcome", "sentence")


def to_csv(report: Report) -> str:
    """A line per episode; perturbations, measures, errors [m], [rad] and times [s] have their columns."""
    rows = [_row(json.loads(episode.result.to_json())) for episode in report.episodes]
    columns = dict.fromkeys(column for row in rows for column in row)
    stream = io.StringIO()
    writer = csv.DictWriter(stream, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return stream.getvalue()


def to_json(report: Report) -> str:
    """Cells, comparisons, failures with their commands, and where all came from, as one JSON object."""
    content = {
        "title": report.title,
        "runs": list(report.runs),
        "planned": report.planned,
        "summary": json.loads(report.summary.to_json()),
        "cells": [_cell(cell) for cell in report.cells],
        "comparisons": [asdict(comparison) for comparison in report.comparisons],
        "outcomes": report.outcomes,
        "failures": [
            {**json.loads(episode.result.comparable_json()), "command": episode.command}
            for episode in report.failures
        ],
        "provenance": report.provenance,
    }
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)


def _cell(cell: Cell) -> dict[str, Any]:
    values = asdict(cell)
    condition: dict[str, Any] = values.pop("condition")
    condition["perturbation"] = dict(condition["perturbation"])
    return condition | values | {"success_rate": cell.rate}


def _row(values: dict[str, Any]) -> dict[str, Any]:
    row: dict[str, Any] = {name: values[name] for name in _PLAIN}
    row |= {f"perturbation.{name}": value for name, value in values["perturbation"].items()}
    row["duration"] = values["duration"]
    row |= values["metrics"]
    for seen in values["objects"]:
        row |= {f"{seen['name']}.{key}": value for key, value in seen.items() if key != "name"}
    row |= {f"time.{stage}": seconds for stage, seconds in values["times"].items()}
    return row
