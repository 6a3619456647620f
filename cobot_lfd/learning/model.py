"""The learnt model: from demonstrations to paths in new scenes."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

import numpy as np

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array
from cobot_lfd.detection import ObjectModel
from cobot_lfd.errors import ModelError
from cobot_lfd.frame import Frame, FrameKind
from cobot_lfd.learning import storage
from cobot_lfd.learning.course.course import Course, ToldBy
from cobot_lfd.learning.course.features import FeatureSet
from cobot_lfd.learning.course.phase import Progress
from cobot_lfd.learning.course.scene_regression import SceneRegression
from cobot_lfd.learning.data import Scenes, TaskDemonstration, TaskFrame, stack_scenes
from cobot_lfd.learning.fitting import learn
from cobot_lfd.learning.kinds.identification import Certainty, Finding
from cobot_lfd.learning.mixtures.encoding import MixtureEncoding, TableEncoding
from cobot_lfd.learning.mixtures.mixture import Mixture
from cobot_lfd.learning.mixtures.profile import Profile
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.learning.product.approach import ApproachAngles
from cobot_lfd.learning.product.frame_product import FrameProduct
from cobot_lfd.learning.product.gather import Visits
from cobot_lfd.learning.settings import EMSettings, LearningSettings, settings_for
from cobot_lfd.recognition import LearntFrame, Part, Recognition

STORED: tuple[type, ...] = (
    Appearance,
    ApproachAngles,
    Certainty,
    Course,
    FeatureSet,
    Finding,
    Frame,
    FrameKind,
    FrameProduct,
    LearntFrame,
    Mixture,
    MixtureEncoding,
    ObjectModel,
    Part,
    Profile,
    Progress,
    Recognition,
    SceneRegression,
    TableEncoding,
    ToldBy,
    Visits,
)
"""What a model file may hold."""

SCENES_AT_ONCE = 64
"""Scenes whose paths are computed together: many, but few enough for a processor's cache."""


@dataclass(frozen=True, slots=True, eq=False)
class TaskParameterisedGMM:
    """A task-parameterised model of a path: made by ``fit`` or ``load``.

    Attributes:
        findings: What was found about each frame, in the order of the demonstrations' frames.
        used_frames: The frames that the path depends on.
        generator: What makes a path of a scene.
        notes: What was chosen while fitting, in sentences.
        duration: Median duration of the demonstrations [s].
        dimension: 2 for planar tasks, 3 for spatial ones.
        method: Name of the method that fitted it; "custom" where settings of one's own were given.
        recognition: How its frames are recognised in a picture; None where they are named objects of a scene.
    """

    findings: tuple[Finding, ...]
    used_frames: tuple[str, ...]
    generator: FrameProduct | Course
    notes: tuple[str, ...]
    duration: float
    dimension: int
    method: str
    recognition: Recognition | None = None

    @classmethod
    def fit(
        cls,
        demonstrations: Sequence[TaskDemonstration],
        *,
        n_components: int | None = None,
        method: str = "improved",
        settings: LearningSettings | None = None,
        frame_kinds: Mapping[str, FrameKind] | None = None,
        tol: float | None = None,
        max_iter: int | None = None,
        reg_covar: float | None = None,
        n_init: int | None = None,
        rng: np.random.Generator | None = None,
    ) -> Self:
        """Learn from demonstrations.

        Args:
            demonstrations: Planar or spatial ones, of any length and sampling, all with the same frames.
            n_components: Number of Gaussians; None: as in the settings, 4 unless changed. The improved method
                fits no mixture, so that this and the other arguments of mixtures have no effect there.
            method: "improved" (the default), "paper" (the published method) or "conventional" (TP-GMM/R).
            settings: All choices in one value; given, ``method`` is not used.
            frame_kinds: Kinds that are known; they are not put to the test.
            tol: Gain of the mean log-likelihood at which mixtures have converged; None: as in the settings.
            max_iter: Limit for their iterations; None: as in the settings.
            reg_covar: Added to their variances, in units of the data's; None: as in the settings.
            n_init: Number of starts with k-means; None: as in the settings.
            rng: For k-means initialisation only.

        Warns:
            UserWarning: If an argument for mixtures is given, and none is fitted.

        Raises:
            ValueError: If a setting is not allowed, or there are too few demonstrations or samples.
            DataError: If the demonstrations' frames differ by name.
        """
        chosen = settings_for(method) if settings is None else settings
        asked = {
            "n_components": n_components,
            "tol": tol,
            "max_iter": max_iter,
            "reg_covar": reg_covar,
            "n_init": n_init,
        }
        given: dict[str, Any] = {name: value for name, value in asked.items() if value is not None}
        if given and not chosen.fits_mixtures:
            warnings.warn(
                f"{', '.join(given)} has no effect: these settings fit no Gaussian mixture; leave it out, or "
                "take method='paper' or 'conventional'.",
                stacklevel=2,
            )
        em: EMSettings = replace(chosen.em, **given)
        chosen = replace(chosen, em=em)
        if frame_kinds is not None:
            chosen = replace(chosen, kinds=dict(frame_kinds))
        learnt = learn(demonstrations, chosen, np.random.default_rng(0) if rng is None else rng)
        return cls(
            tuple(learnt.findings),
            learnt.used_frames,
            learnt.generator,
            tuple(learnt.notes),
            learnt.duration,
            learnt.dimension,
            method if settings is None else "custom",
        )

    @property
    def names(self) -> tuple[str, ...]:
        """All frames of the demonstrations."""
        return tuple(finding.name for finding in self.findings)

    @property
    def frame_kinds(self) -> Mapping[str, FrameKind]:
        """Whether the path depends on the direction of each frame."""
        return MappingProxyType({finding.name: finding.kind for finding in self.findings})

    def explain(self) -> str:
        """What was found, dropped and chosen, in sentences."""
        dropped = [name for name in self.names if name not in self.used_frames]
        lines = [finding.reason for finding in self.findings]
        lines += [f"'{name}' is left out: without it new scenes are predicted as well." for name in dropped]
        return "\n".join([*lines, *self.notes])

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
        means, covariances = self.generate(stack_scenes(scenes, self.used_frames), n_steps)
        return GeneratedPath.batch(means, covariances, np.linspace(0.0, self.duration, n_steps))

    def generate(self, scenes: Scenes, n_steps: int = 200) -> tuple[Array, Array]:
        """Many paths as arrays.

        Args:
            scenes: The used frames of S scenes.
            n_steps: Number of positions T.

        Returns:
            Means [m], shape (S, T, d), and covariances [m²], shape (S, T, d, d).

        Raises:
            ModelError: If the scenes are spatial and the model is planar, or the other way round.
        """
        if scenes.positions.shape[-1] != self.dimension:
            raise ModelError(
                f"the scene's frames have {scenes.positions.shape[-1]} dimensions, the model was learnt in "
                f"{self.dimension}; give it frames of the same kind as the demonstrations'."
            )
        s, d = len(scenes), self.dimension
        means, covariances = np.empty((s, n_steps, d)), np.empty((s, n_steps, d, d))
        for start in range(0, s, SCENES_AT_ONCE):
            part = slice(start, start + SCENES_AT_ONCE)
            means[part], covariances[part] = self.generator.generate(scenes.only(part), n_steps)
        return means, covariances

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
        n, d = len(self.used_frames), self.dimension
        scenes = Scenes(np.arange(n * d, dtype=np.float64).reshape(1, n, d), np.tile(np.eye(d), (1, n, 1, 1)))
        try:
            mean, covariance = self.generate(scenes, 5)
        except (ValueError, TypeError, AttributeError, IndexError, KeyError, np.linalg.LinAlgError):
            return False
        return mean.shape == (1, 5, d) and bool(np.isfinite(mean).all() and np.isfinite(covariance).all())
