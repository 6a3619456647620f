"""The demonstrations that a folder keeps, with what a list says about each."""

from dataclasses import dataclass
from pathlib import Path
from typing import Self

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.quality import Quality, assess
from cobot_lfd.app.demonstrations.store import episode_number, list_episodes, load_episode
from cobot_lfd.errors import DataError


@dataclass(frozen=True, slots=True)
class Kept:
    """What a folder keeps.

    Attributes:
        episodes: Number to episode.
        qualities: Number to what a list says about it.
        damaged: What is wrong with the files that cannot be read, a sentence each.
    """

    episodes: dict[int, RecordedEpisode]
    qualities: dict[int, Quality]
    damaged: tuple[str, ...]

    @classmethod
    def read(cls, folder: Path) -> Self:
        """Read a folder; one that is not there yet keeps nothing, and a damaged file hides no other."""
        episodes, damaged = {}, []
        for path in list_episodes(folder) if folder.is_dir() else []:
            try:
                episodes[episode_number(path)] = load_episode(path)
            except DataError as error:
                damaged.append(str(error))
        return cls(episodes, {number: assess(one) for number, one in episodes.items()}, tuple(damaged))

    @property
    def good(self) -> list[RecordedEpisode]:
        """The episodes that can be learnt from."""
        return [
            one for one in self.episodes.values() if one.verdict.succeeded and int(one.carrying.sum()) >= 2
        ]
