"""cobot-lfd fit: demonstrations to a model."""

from dataclasses import replace
from pathlib import Path
from textwrap import indent
from typing import Literal

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE
from cobot_lfd.app.demonstrations.store import load_kept
from cobot_lfd.app.discovery.camera import camera_of
from cobot_lfd.app.discovery.discover import discover
from cobot_lfd.app.discovery.told import told
from cobot_lfd.learning.model import TaskParameterisedGMM


def fit(
    demos: Positional[Path],
    *,
    out: Path,
    method: Literal["improved", "paper", "conventional"] = "improved",
    n_components: int | None = None,
    frames: Literal["named", "auto"] = "named",
) -> int:
    """Learn a model from the demonstrations that did the task.

    Args:
        demos: Folder of demonstrations.
        out: File for the model, ending in .npz.
        method: The product's best configuration, the paper's, or conventional TP-GMM/R.
        n_components: Number of Gaussians, for methods that fit mixtures.
        frames: "named" takes the objects that the recordings name; "auto" finds the frames that matter in
            the pictures and paths alone, and the model recognises them in new pictures by itself.
    """
    episodes = load_kept(demos)
    if frames == "auto":
        discovery = discover(episodes, camera_of(episodes))
        print(told(discovery))
        demonstrations = list(discovery.demonstrations)
        kinds = discovery.known_kinds if method != "conventional" else None
        fitted = TaskParameterisedGMM.fit(
            demonstrations, method=method, n_components=n_components, frame_kinds=kinds
        )
        model = replace(fitted, recognition=discovery.recognition)
    else:
        demonstrations = [episode.demonstration() for episode in episodes]
        model = TaskParameterisedGMM.fit(demonstrations, method=method, n_components=n_components)
    out.parent.mkdir(parents=True, exist_ok=True)
    model.save(out)
    print(f"learnt from {len(demonstrations)} demonstrations ({method}):")
    for name, kind in model.frame_kinds.items():
        print(f"  frame {name}: {kind.value}")
    print(indent(model.explain(), "  "))
    print(f"the model is in {out}")
    return DONE
