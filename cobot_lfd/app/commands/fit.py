"""cobot-lfd fit: demonstrations to a model."""

from pathlib import Path
from textwrap import indent
from typing import Literal

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE
from cobot_lfd.app.demonstrations.store import load_demonstrations
from cobot_lfd.learning.model import TaskParameterisedGMM


def fit(
    demos: Positional[Path],
    *,
    out: Path,
    method: Literal["improved", "paper", "conventional"] = "improved",
    n_components: int = 4,
) -> int:
    """Learn a model from the demonstrations that did the task.

    Args:
        demos: Folder of demonstrations.
        out: File for the model, ending in .npz.
        method: The product's best configuration, the paper's, or conventional TP-GMM/R.
        n_components: Number of Gaussians, where the method fits mixtures.
    """
    demonstrations = load_demonstrations(demos)
    model = TaskParameterisedGMM.fit(demonstrations, method=method, n_components=n_components)
    out.parent.mkdir(parents=True, exist_ok=True)
    model.save(out)
    print(f"learnt from {len(demonstrations)} demonstrations ({method}):")
    for name, kind in model.frame_kinds.items():
        print(f"  frame {name}: {kind.value}")
    print(indent(model.explain(), "  "))
    print(f"the model is in {out}")
    return DONE
