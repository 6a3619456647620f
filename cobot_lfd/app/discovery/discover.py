"""Which frames a task has: found in its demonstrations' pictures, chosen by how they predict the paths."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.discovery.candidates import BASE, Candidates, find_candidates
from cobot_lfd.app.discovery.decisions import Decision, Fate, decide
from cobot_lfd.camera import Camera
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame, FrameKind
from cobot_lfd.learning.frame_choice import FrameChoice, choose_frames
from cobot_lfd.recognition import LearntFrame, Part, Recognition
from perception.discovery import Motion, Track

_FEWEST = 3  # Demonstrations; of two, none can be left out and predicted from the rest.


@dataclass(frozen=True, slots=True, eq=False)
class Discovery:
    """All that was found out.

    Attributes:
        candidates: What could be a frame.
        decisions: What became of each, in the candidates' order.
        choice: How left-out demonstrations were predicted.
        demonstrations: The paths with the kept frames.
        recognition: How the kept frames are recognised in new pictures.
        kinds: The kept frames' kinds.
        known_kinds: Those of them that follow from what was seen: what never moves has axes, what looks the
            same when turned has none.
    """

    candidates: Candidates
    decisions: tuple[Decision, ...]
    choice: FrameChoice
    demonstrations: tuple[Demonstration, ...]
    recognition: Recognition
    kinds: Mapping[str, FrameKind]
    known_kinds: Mapping[str, FrameKind]

    @property
    def kept(self) -> tuple[str, ...]:
        """Names of the frames that matter."""
        return tuple(item.name for item in self.decisions if item.fate is Fate.KEPT)


def discover(episodes: Sequence[RecordedEpisode], camera: Camera) -> Discovery:
    """Find the frames of a task in its demonstrations; what their files say about objects is not used.

    Args:
        episodes: At least three demonstrations with pictures.
        camera: The camera that took the pictures.

    Raises:
        DataError: If there are too few demonstrations, or they have no pictures of this camera.
    """
    _require_pictures(episodes, camera)
    candidates = find_candidates([episode.picture for episode in episodes], camera)
    if not candidates.models:
        raise DataError(
            "nothing that stands out from the table reappears in the pictures, so there is no frame to find. "
            "Name the frames (leave out --frames auto), or record things of other colours than the table's."
        )
    frames = {motion.members[0]: _frames(motion, candidates.tracks) for motion in candidates.motions}
    usable = {name: found for name, found in frames.items() if not isinstance(found, str)}
    shown = [
        Demonstration(
            episode.tool_positions[episode.carrying, :2],
            {name: found[n] for name, found in usable.items()},
            episode.times[episode.carrying],
        )
        for n, episode in enumerate(episodes)
    ]
    known_kinds = _known_kinds(usable, candidates)
    choice = choose_frames(shown, known_kinds)
    decisions = decide(candidates, frames, choice)
    kept = [item.name for item in decisions if item.fate is Fate.KEPT]
    return Discovery(
        candidates,
        decisions,
        choice,
        tuple(Demonstration(d.path, {name: d.frames[name] for name in kept}, d.times) for d in shown),
        _recognition(candidates, kept),
        {name: choice.kinds[name] for name in kept},
        {name: kind for name, kind in known_kinds.items() if name in kept},
    )


def _require_pictures(episodes: Sequence[RecordedEpisode], camera: Camera) -> None:
    if len(episodes) < _FEWEST:
        raise DataError(
            f"{len(episodes)} demonstrations are too few to find frames in; at least {_FEWEST} are needed, "
            "so that each can be predicted from the others. Record more."
        )
    for episode in episodes:
        height, width = episode.picture.shape[:2]
        if not episode.picture.size:
            raise DataError(
                f"the demonstration of seed {episode.seed} has no picture, so no frame can be found in it. "
                "Record it with a camera, or name its frames (leave out --frames auto)."
            )
        if (width, height) != (camera.width, camera.height):
            raise DataError(
                f"the picture of the demonstration of seed {episode.seed} is {width} x {height} px; the "
                f"camera's are {camera.width} x {camera.height} px. Learn from demonstrations of one camera."
            )
        if episode.carrying.sum() < 2:
            raise DataError(
                f"the demonstration of seed {episode.seed} carries nothing; take it out with cobot-lfd demos."
            )


def _frames(motion: Motion, tracks: Mapping[str, Track]) -> list[Frame] | str:
    """The frame of a group in each demonstration, or why there is none."""
    n_demonstrations = len(tracks[BASE].sightings)
    frames = []
    for n in range(n_demonstrations):
        frame = next(
            (
                seen.frame @ offset
                for name, offset in zip(motion.members, motion.offsets, strict=True)
                if isinstance(seen := tracks[name].sightings[n], Detection)
                and (name == motion.members[0] or seen.symmetry == 1)  # else it may lie on either side
            ),
            None,
        )
        if frame is None:
            why = tracks[motion.members[0]].sightings[n]
            reason = (
                why.reason if isinstance(why, NotSeen) else "only a part that does not tell its direction is."
            )
            return f"it moves, and where it was in demonstration {n + 1} cannot be told: {reason}"
        frames.append(frame)
    return frames


def _known_kinds(names: Mapping[str, object], candidates: Candidates) -> dict[str, FrameKind]:
    """Kinds that need no test: what never turns has axes, what looks the same when turned has none."""
    return {
        name: FrameKind.ORIENTED if name == BASE else FrameKind.ORIENTATION_LESS
        for name in names
        if name == BASE or candidates.tracks[name].symmetry > 1
    }


def _recognition(candidates: Candidates, kept: Sequence[str]) -> Recognition:
    frames = []
    used = set()
    for motion in candidates.motions:
        first = motion.members[0]
        if first not in kept:
            continue
        if first == BASE:
            frames.append(LearntFrame(BASE, (), Frame(np.zeros(2), 0.0)))
            continue
        parts = zip(motion.members, motion.offsets, strict=True)
        frames.append(
            LearntFrame(first, tuple(Part(candidates.models[name], offset) for name, offset in parts))
        )
        used |= set(motion.members)
    others = tuple(model for name, model in candidates.models.items() if name not in used)
    return Recognition(tuple(frames), others)
