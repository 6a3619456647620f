"""Plans and stand-ins for episodes: as quick as can be, well or ill behaved, in processes of their own."""

import os
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cobot_lfd.app.evaluation.contender import Contender
from cobot_lfd.app.evaluation.perform import Performed, labelled
from cobot_lfd.app.evaluation.perturbation import Perturbation
from cobot_lfd.app.evaluation.plan import Plan, Trial
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.frame import Frame
from cobot_lfd.outcome import Outcome
from tests.app_examples import result

DIES, DIES_ONCE, HANGS, RAISES = 2, 3, 4, 5
"""Seeds of the episodes that misbehave."""


def small_plan(n: int = 8) -> Plan:
    """One contender in the first ``n`` seeds."""
    return Plan.of(
        scenes=("pick_and_place",),
        robots=("panda",),
        contenders=(Contender("line", "line", b"[]"),),
        perturbations=(Perturbation(),),
        seeds=range(n),
    )


def stand_in(trial: Trial) -> Performed:
    """A result that depends on the trial alone; every third episode fails and has a picture."""
    failed = trial.seed % 3 == 0
    made_up = result(trial.seed, Outcome.GRASP_LOST if failed else Outcome.SUCCESS)
    made_up = replace(made_up, times={"execute": time.perf_counter()})
    return Performed(labelled(trial, made_up), b"picture" if failed else b"")


@dataclass(frozen=True)
class IllBehaved:
    """Performs trials, but the process dies, hangs or raises at certain seeds.

    Attributes:
        folder: Where it is noted that an episode has died already.
    """

    folder: Path

    def __call__(self, trial: Trial) -> Performed:
        """Perform one trial."""
        note = self.folder / str(trial.seed)
        if trial.seed == DIES or (trial.seed == DIES_ONCE and not note.exists()):
            note.touch()
            os._exit(7)
        if trial.seed == HANGS:
            time.sleep(600)
        if trial.seed == RAISES:
            raise ZeroDivisionError("on purpose")
        return stand_in(trial)


def slow_stand_in(trial: Trial) -> Performed:
    """A stand-in that takes a moment."""
    time.sleep(0.02)
    return stand_in(trial)


def sweep_demonstrations(n: int = 5) -> list[Demonstration]:
    """Demonstrations from one frame to another, both anywhere, along a slight bow, by a shaky hand."""
    rng = np.random.default_rng(0)
    demonstrations = []
    for _ in range(n):
        frames = {name: Frame(rng.uniform(-0.5, 0.5, 2), float(rng.uniform(-3, 3))) for name in ("a", "b")}
        u = np.linspace(0.0, 1.0, 60)[:, None]
        start, end = frames["a"].apply([0.05, 0.0]), frames["b"].position
        wander = rng.normal(0.0, 0.01, 2) + rng.normal(0.0, 0.01, 2) * u
        path = start + u * (end - start) + 0.02 * np.sin(np.pi * u) + wander
        path += rng.normal(0.0, 0.003, path.shape)
        demonstrations.append(Demonstration(path, frames))
    return demonstrations
