"""cobot-lfd validate: how well methods predict demonstrations that they have not seen."""

import json as json_format
from dataclasses import asdict
from pathlib import Path

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE
from cobot_lfd.app.demonstrations.store import load_demonstrations
from cobot_lfd.app.evaluation.validate import Validation, cross_validate

_PAPER = (
    ("sorting, all frames oriented", 0.0127, 0.0004, 0.0412),
    ("sorting, kinds identified", 0.0113, 0.0024, 0.0346),
    ("handover, all frames oriented", 0.0726, 0.0039, 0.0086),
    ("handover, kinds identified", 0.0097, 0.0078, 0.0058),
    ("pick-and-place, all frames oriented", 0.0510, 0.0048, 0.0747),
    ("pick-and-place, kinds identified", 0.0248, 0.0177, 0.0121),
)
"""The paper's Table 5: one demonstration held back of six, in a simulation of its own."""


def validate(
    demos: Positional[Path],
    *,
    method: tuple[str, ...] = ("improved", "paper", "conventional"),
    json: bool = False,
) -> int:
    """Leave out each demonstration in turn, learn from the others, and compare; needs no simulation.

    Args:
        demos: Folder of demonstrations.
        method: Methods to compare: improved, paper, conventional, line, world-gmr, dmp, or
            package.module:Class for one of your own.
        json: Print the distances of every demonstration as JSON.
    """
    demonstrations = load_demonstrations(demos)
    validations = [cross_validate(name, demonstrations) for name in method]
    if json:
        print(
            json_format.dumps({v.method: [asdict(fold) for fold in v.folds] for v in validations}, indent=2)
        )
    else:
        print(f"distances to each of {len(demonstrations)} demonstrations, learnt from the others [m]:")
        print(_table(validations))
    return DONE


def _table(validations: list[Validation]) -> str:
    lines = [f"{'':40} {'d_total':>16} {'d_start':>16} {'d_end':>16}"]
    for validation in validations:
        mean, error = validation.mean, validation.standard_error
        pairs = ((mean.total, error.total), (mean.start, error.start), (mean.end, error.end))
        lines.append(f"{validation.method:40} " + " ".join(f"{m:.4f} ± {e:.4f}".rjust(16) for m, e in pairs))
    lines.append("the paper's Table 5, one demonstration held back of six:")
    lines += [f"{name:40} {total:16.4f} {start:16.4f} {end:16.4f}" for name, total, start, end in _PAPER]
    return "\n".join(lines)
