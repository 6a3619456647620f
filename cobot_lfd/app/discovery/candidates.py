"""The candidates: things that the pictures of several demonstrations show, and the base that never moves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cobot_lfd.camera import Camera
from cobot_lfd.detection import ObjectModel
from perception.discovery import (
    Description,
    Kind,
    Motion,
    Thing,
    Track,
    base_track,
    describe,
    match,
    merge,
    names_of,
    propose,
    recognise,
    textured,
)

BASE = "base"
"""Name of the frame that never moves: the robot's base, on the table."""

Picture = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class Candidates:
    """What could be a frame.

    Attributes:
        models: What the things look like, by name.
        tracks: Where they were in each demonstration, by name; the base among them.
        motions: Which of them move as one.
        strays: Sentences about what was seen too seldom to be a candidate.
    """

    models: dict[str, ObjectModel]
    tracks: dict[str, Track]
    motions: tuple[Motion, ...]
    strays: tuple[str, ...]


def find_candidates(pictures: Sequence[Picture], camera: Camera) -> Candidates:
    """Find the things that reappear, learn what they look like, and which of them move together.

    Args:
        pictures: A picture of each demonstration.
        camera: The camera that took them.
    """
    things = [propose(picture, camera) for picture in pictures]
    kinds = match(things, camera)
    learnt = [(kind, _learn(kind, pictures, things, camera)) for kind in kinds if kind.n_seen > 1]
    known = [(kind, found) for kind, found in learnt if found is not None]
    told = [[things[n][i] for kind, _ in known for i in kind.members[n]] for n in range(len(pictures))]
    alone = [(1, model) for model in textured(pictures, camera, told)]
    models = _named([*((kind.count, found.model) for kind, found in known), *alone])
    seen = [recognise(p, camera, models, shown) for p, shown in zip(pictures, things, strict=True)]
    tracks = [base_track(BASE, len(pictures))]
    tracks += [Track(model.name, tuple(found[i] for found in seen)) for i, model in enumerate(models)]
    return Candidates(
        {model.name: model for model in models},
        {track.name: track for track in tracks},
        merge(tracks),
        tuple(_stray(kind, len(pictures)) for kind in kinds if kind.n_seen < 2),
    )


def _learn(
    kind: Kind, pictures: Sequence[Picture], things: Sequence[Sequence[Thing]], camera: Camera
) -> Description | None:
    """What a kind looks like, learnt from everything that shows it whole."""
    shown = [
        (pictures[n], things[n][i])
        for n, members in enumerate(kind.members)
        for i in members
        if not things[n][i].region.at_border
    ]
    return describe("thing", [p for p, _ in shown], [t for _, t in shown], camera) if len(shown) > 1 else None


def _named(models: Sequence[tuple[int, ObjectModel]]) -> list[ObjectModel]:
    """A model for each thing, of as many as look the same."""
    repeated = [model for count, model in models for _ in range(count)]
    names = names_of([255.0 * model.colour for model in repeated])
    return [_called(model, name) for model, name in zip(repeated, names, strict=True)]


def _called(model: ObjectModel, name: str) -> ObjectModel:
    face = None if model.appearance is None else replace(model.appearance, name=name)
    return replace(model, name=name, appearance=face)


def _stray(kind: Kind, n_pictures: int) -> str:
    place = next(n for n, members in enumerate(kind.members) if members)
    return f"something in demonstration {place + 1} that no other of the {n_pictures} pictures shows."
