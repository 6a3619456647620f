"""The learnt model: from demonstrations to paths in new scenes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Self

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.errors import ModelError
from cobot_lfd.frame import FrameKind
from cobot_lfd.learning import storage, symmetric
from cobot_lfd.learning.bearing import bearing_evidence
from cobot_lfd.learning.criteria import fulfilled
from cobot_lfd.learning.data import (
    Scenes,
    TaskData,
    TaskDemonstration,
    TaskFrame,
    collect,
    stack_scenes,
)
from cobot_lfd.learning.em import fit_mixture
from cobot_lfd.learning.encoding import Encoding, MixtureEncoding, TableEncoding, fit_rings, tabulate
from cobot_lfd.learning.generate import Visits, find_visits, gather
from cobot_lfd.learning.mixture import Mixture
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.learning.profile import Profile
from cobot_lfd.learning.settings import Encode, Identifier, LearningSettings, RingDirection, settings_for

MAX_TABLE_STEPS = 200
"""Steps of the table of kernel statistics; its kernel is several steps wide."""


STORED: tuple[type, ...] = (Mixture, MixtureEncoding, TableEncoding, Profile, Visits)
"""What a model file may hold."""


@dataclass(frozen=True, slots=True, eq=False)
class TaskParameterisedGMM:
    """A task-parameterised model of a path: made by ``fit`` or ``load``.

    Attributes:
        method: Name of the method that it was fitted by; "custom" where settings of one's own were given.
        names: The frames, in the model's order.
        oriented: Whether each frame's direction matters.
        encoding: What is known of the path seen from each frame.
        visits: When the path comes closest to each frame; None: rings look towards the nearest frame.
        duration: Median duration of the demonstrations [s].
        dimension: 2 for planar tasks, 3 for spatial ones.
    """

    method: str
    names: tuple[str, ...]
    oriented: tuple[bool, ...]
    encoding: Encoding
    visits: Visits | None
    duration: float
    dimension: int

    @classmethod
    def fit(
        cls,
        demonstrations: Sequence[TaskDemonstration],
        *,
        n_components: int = 4,
        method: str = "improved",
        settings: LearningSettings | None = None,
        rng: np.random.Generator | None = None,
    ) -> Self:
        """Learn from demonstrations.

        Args:
            demonstrations: Planar or spatial ones, of any length and sampling, all with the same frames.
            n_components: Number of Gaussians where mixtures are fitted.
            method: "improved" (the default), "paper" (the published method) or "conventional" (TP-GMM/R).
            settings: All choices in one value; given, ``method`` is not used.
            rng: For k-means initialisation only.

        Raises:
            ValueError: If a setting is not allowed, or there are too few demonstrations or samples.
            DataError: If the demonstrations' frames differ by name.
        """
        chosen = settings_for(method) if settings is None else settings
        chosen = replace(chosen, em=replace(chosen.em, n_components=n_components))
        rng = np.random.default_rng(0) if rng is None else rng
        data = collect(demonstrations, None if chosen.encode is Encode.MIXTURE else MAX_TABLE_STEPS)
        oriented = _kinds(data, chosen)
        encoding, oriented = _encode(data, chosen, oriented, rng)
        visits = find_visits(data) if chosen.ring_direction is RingDirection.SEQUENCE else None
        return cls(
            method if settings is None else "custom",
            data.names,
            oriented,
            encoding,
            visits,
            data.duration,
            data.paths.shape[-1],
        )

    @property
    def frame_kinds(self) -> Mapping[str, FrameKind]:
        """Whether the path depends on the direction of each frame."""
        kinds = {
            name: FrameKind.ORIENTED if oriented else FrameKind.ORIENTATION_LESS
            for name, oriented in zip(self.names, self.oriented, strict=True)
        }
        return MappingProxyType(kinds)

    def reproduce(self, frames: Mapping[str, TaskFrame], n_steps: int = 200) -> GeneratedPath:
        """The path for the frames of a new scene.

        Args:
            frames: Name to frame; frames that the model does not know are left aside.
            n_steps: Number of positions, equally spaced in time.

        Raises:
            ModelError: If a frame is missing.
        """
        return self.reproduce_many([frames], n_steps)[0]

    def reproduce_many(
        self, scenes: Sequence[Mapping[str, TaskFrame]], n_steps: int = 200
    ) -> list[GeneratedPath]:
        """The paths for many scenes, in one vectorised computation.

        Raises:
            ModelError: If a scene lacks a frame.
        """
        if n_steps < 2:
            raise ValueError(f"n_steps is {n_steps}; it must be at least 2.")
        if not scenes:
            return []
        means, covariances = self.generate(stack_scenes(scenes, self.names), n_steps)
        times = np.linspace(0.0, self.duration, n_steps)
        return [GeneratedPath(m, c, times) for m, c in zip(means, covariances, strict=True)]

    def generate(self, scenes: Scenes, n_steps: int = 200) -> tuple[Array, Array]:
        """Means [m], shape (S, T, d), and covariances [m²], shape (S, T, d, d), for scenes as arrays."""
        times = np.linspace(0.0, 1.0, n_steps)
        profile = self.encoding.profile(times)
        mean, covariance = gather(profile, scenes, self.oriented, times, self.visits).moments()
        return np.swapaxes(mean, 1, 2), symmetric.unpack(covariance, self.dimension)

    def save(self, path: Path | str) -> None:
        """Write the model to a file that holds numbers and text only."""
        storage.save(Path(path), self)

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """Read a model; nothing in the file is executed.

        Raises:
            ModelError: If the file is missing, damaged, no model, or of a version that cannot be read.
        """
        classes = {"TaskParameterisedGMM": cls} | {part.__name__: part for part in STORED}
        model = storage.load(Path(path), classes)
        if not isinstance(model, cls) or not model._is_sound():
            raise ModelError(f"{path} is damaged: its parts do not fit together; fit the model again.")
        return model

    def _is_sound(self) -> bool:
        """Whether a path comes out for one made-up scene."""
        n, d = len(self.names), self.dimension
        scenes = Scenes(np.arange(n * d, dtype=np.float64).reshape(1, n, d), np.tile(np.eye(d), (1, n, 1, 1)))
        try:
            mean, covariance = self.generate(scenes, 5)
        except (ValueError, TypeError, AttributeError, IndexError, KeyError, np.linalg.LinAlgError):
            return False
        return mean.shape == (1, 5, d) and bool(np.isfinite(mean).all() and np.isfinite(covariance).all())


def _kinds(data: TaskData, settings: LearningSettings) -> tuple[bool, ...]:
    """Which frames are oriented; all, where this is to be decided later or cannot be."""
    if settings.identifier is not Identifier.BEARING or len(data.names) == 1 or len(data.paths) < 2:
        return (True,) * len(data.names)
    evidence = bearing_evidence(data, settings.bearing).max(axis=1)
    return tuple(bool(e > settings.bearing.margin) for e in evidence)


def _encode(
    data: TaskData, settings: LearningSettings, oriented: tuple[bool, ...], rng: np.random.Generator
) -> tuple[Encoding, tuple[bool, ...]]:
    """What is known of the path seen from each frame, and the frames' kinds."""
    if settings.encode is Encode.KERNEL:
        return tabulate(data, settings.kernel_width, settings.em.reg_covar), oriented
    mixture = fit_mixture(data.local, data.times, settings.em, rng).mixture
    if settings.identifier is Identifier.CRITERIA and len(data.names) > 1:
        oriented = tuple(bool(f) for f in np.any(fulfilled(mixture, settings.criteria), axis=0))
    less = [j for j, is_oriented in enumerate(oriented) if not is_oriented]
    rings = {j: fit.mixture for j, fit in fit_rings(data, less, settings.em, rng).items()}
    return MixtureEncoding(mixture, rings), oriented
