"""All that a report says, gathered from one or more runs."""

import json
import shlex
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cobot_lfd.app.disk import told
from cobot_lfd.app.report.cells import Cell, Condition, cells_of, condition_of
from cobot_lfd.app.report.paired import Comparison, comparisons_of
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.run_folder import PROVENANCE, RunFolder
from cobot_lfd.app.summary import Summary
from cobot_lfd.errors import DataError

_MOST_NAMES = 3  # that a title can hold


@dataclass(frozen=True, slots=True)
class Episode:
    """An episode in a report.

    Attributes:
        result: What happened; its contender is named so that runs can be told apart.
        condition: What it has in common with others.
        command: Runs it again.
        picture: What the camera saw, where it failed and a picture was kept.
        video: A video of it, where one was made.
    """

    result: EpisodeResult
    condition: Condition
    command: str
    picture: Path | None
    video: Path | None


@dataclass(frozen=True, slots=True)
class Report:
    """All that a report says.

    Attributes:
        title: What was compared, where, and by which arm.
        runs: Names of the runs.
        summary: Of all episodes together.
        planned: Number of episodes in the runs' plans.
        cells: Results by condition.
        comparisons: Contenders on the same seeds.
        outcomes: Sentence of each kind of outcome with its number by contender.
        episodes: All of them, in the plans' order.
        provenance: Where each run came from, by the run's name.
    """

    title: str
    runs: tuple[str, ...]
    summary: Summary
    planned: int
    cells: tuple[Cell, ...]
    comparisons: tuple[Comparison, ...]
    outcomes: Mapping[str, Mapping[str, int]]
    episodes: tuple[Episode, ...]
    provenance: Mapping[str, Mapping[str, Any]]

    @property
    def failures(self) -> list[Episode]:
        """The episodes that did not succeed."""
        return [episode for episode in self.episodes if not episode.result.verdict.succeeded]

    @property
    def contenders(self) -> list[str]:
        """Names of what was compared, in the order of the results."""
        return list(dict.fromkeys(cell.condition.contender for cell in self.cells))


def gather(folders: Sequence[Path]) -> Report:
    """Read runs, finished or not.

    Raises:
        DataError: If a folder holds no run, or none of them has a result.
    """
    runs = [RunFolder.open(folder) for folder in folders]
    names = _names(folders)
    episodes = [
        episode
        for name, run in zip(names, runs, strict=True)
        for episode in _episodes(run, prefix=f"{name}/" if len(runs) > 1 else "")
    ]
    if not episodes:
        raise DataError(
            f"{', '.join(map(str, folders))}: no episode has ended yet; there is nothing to report."
        )
    results = [episode.result for episode in episodes]
    return Report(
        title=_title(results),
        runs=tuple(names),
        summary=Summary.of(results),
        planned=sum(len(run.plan) for run in runs),
        cells=tuple(cells_of(results)),
        comparisons=tuple(comparisons_of(results)),
        outcomes=_outcomes(results),
        episodes=tuple(episodes),
        provenance={name: _provenance(run) for name, run in zip(names, runs, strict=True)},
    )


def _title(results: Sequence[EpisodeResult]) -> str:
    """Such as "improved and conventional in pick_and_place with panda"."""
    contenders = _listed((r.contender for r in results), "contenders")
    scenes, robots = (
        _listed((r.scene for r in results), "scenes"),
        _listed((r.robot for r in results), "arms"),
    )
    return f"{contenders} in {scenes} with {robots}"


def _listed(names: Iterable[str], kind: str) -> str:
    """A few names, or the number of many."""
    different = list(dict.fromkeys(names))
    if len(different) > _MOST_NAMES:
        return f"{len(different)} {kind}"
    return " and ".join([", ".join(different[:-1]), different[-1]] if len(different) > 1 else different)


def _names(folders: Sequence[Path]) -> list[str]:
    """The folders' own names, or their paths where those are not enough to tell them apart."""
    names = [folder.resolve().name for folder in folders]
    return names if len(set(names)) == len(names) else [str(folder) for folder in folders]


def _episodes(run: RunFolder, prefix: str) -> list[Episode]:
    episodes = []
    for result in run.results():
        named = replace(result, contender=prefix + (result.contender or result.method))
        picture, video = run.picture(result.trial), run.video(result.trial)
        command = f"cobot-lfd replay {shlex.quote(str(run.path))} {result.trial} --picture seen.png"
        episodes.append(
            Episode(
                result=named,
                condition=condition_of(named),
                command=command,
                picture=picture if picture.exists() else None,
                video=video if video.exists() else None,
            )
        )
    return episodes


def _outcomes(results: Sequence[EpisodeResult]) -> dict[str, dict[str, int]]:
    counts = Counter((r.verdict.outcome.value, r.contender) for r in results)
    totals = Counter(r.verdict.outcome.value for r in results)
    contenders = dict.fromkeys(r.contender for r in results)
    return {
        sentence: {name: counts[sentence, name] for name in contenders}
        for sentence, _ in totals.most_common()
    }


def _provenance(run: RunFolder) -> dict[str, Any]:
    """Where a run came from, with the checksums of what was compared."""
    with told(run.path / PROVENANCE, "read"):
        text = (run.path / PROVENANCE).read_text(encoding="utf-8")
    try:
        values = {key: value for key, value in json.loads(text).items() if not key.startswith("model")}
    except (ValueError, AttributeError) as error:
        raise DataError(f"{run.path / PROVENANCE} is damaged: {error}.") from error
    seeds = run.plan.seeds
    contenders = {c.label: f"SHA-256 {c.sha256}" for c in run.plan.contenders}
    return {
        "run": run.plan.run,
        **values,
        "seeds": f"{seeds.start} to {seeds.stop - 1}",
        "contenders": contenders,
        "folder": str(run.path),
    }
