"""Each improvement can be switched on alone, and does what it is for."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd import FrameKind, TaskParameterisedGMM
from cobot_lfd.learning.data import TaskDemonstration
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations, draw_scene, planar, true_path
from cobot_lfd.learning.metrics import log_dimensionless_jerk
from cobot_lfd.learning.mixtures.sharing import SharedQuantity, Sharing
from cobot_lfd.learning.product.frame_product import FrameProduct
from cobot_lfd.learning.settings import (
    CONVENTIONAL,
    IMPROVED,
    PAPER,
    Alignment,
    Encode,
    Generator,
    Identifier,
    LearningSettings,
    RingDirection,
    ToldBy,
    settings_for,
)

KINDS = {"start": FrameKind.ORIENTED, "end": FrameKind.ORIENTATION_LESS}
OPTIONS = {
    "the paper's method": PAPER,
    "densities": replace(PAPER, em=replace(PAPER.em, sharing=Sharing(quantity=SharedQuantity.DENSITY))),
    "log densities": replace(
        PAPER, em=replace(PAPER.em, sharing=Sharing(1.0, 10, SharedQuantity.LOG_DENSITY))
    ),
    "k-means": replace(PAPER, em=replace(PAPER.em, init="kmeans")),
    "fully shared components": replace(PAPER, em=replace(PAPER.em, sharing=Sharing(1.0))),
    "kernel statistics": replace(PAPER, encode=Encode.KERNEL, identifier=Identifier.BEARING),
    "bearing": replace(PAPER, identifier=Identifier.BEARING),
    "sequence": replace(PAPER, ring_direction=RingDirection.SEQUENCE),
    "approach angle": replace(PAPER, ring_direction=RingDirection.SEQUENCE, approach_angle=True),
    "tracking": replace(PAPER, jerk_weight=1e-7),
    "frame selection": replace(PAPER, select_frames=True),
    "time warping": replace(PAPER, alignment=Alignment.WARP),
    "time warping, chosen": replace(PAPER, encode=Encode.KERNEL, alignment=Alignment.CHOSEN),
    "choice of K": replace(PAPER, component_choices=(3, 4)),
    "scene regression": replace(PAPER, generator=Generator.COURSE),
    "scene regression over time": replace(IMPROVED, course=replace(IMPROVED.course, told_by=(ToldBy.TIME,))),
    "scene regression, warped": replace(IMPROVED, course=replace(IMPROVED.course, told_by=(ToldBy.WARP,))),
    "no straightening": replace(IMPROVED, course=replace(IMPROVED.course, straighten=False)),
    "no smoothing": replace(IMPROVED, course=replace(IMPROVED.course, smooth=False)),
}


def demos(seed: int = 0) -> list[TaskDemonstration]:
    return list(demonstrations(TASKS[2], 6, np.random.default_rng(seed), n_steps=100))


def fit(settings: LearningSettings, seed: int = 0) -> TaskParameterisedGMM:
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="component")
        return TaskParameterisedGMM.fit(demos(seed), settings=settings, frame_kinds=KINDS)


def error(settings: LearningSettings, seeds: range = range(3)) -> float:
    """Mean distance from the truth in new scenes [m]."""
    apart = []
    for seed in seeds:
        rng = np.random.default_rng([9, seed])
        scenes = [draw_scene(TASKS[2], rng) for _ in range(20)]
        paths = fit(settings, seed).reproduce_many([planar(scene) for scene in scenes])
        truth = [true_path(TASKS[2], scene) for scene in scenes]
        apart += [np.linalg.norm(p.mean - t, axis=1).mean() for p, t in zip(paths, truth, strict=True)]
    return float(np.mean(apart))


@pytest.mark.parametrize("name", OPTIONS)
def test_an_option_alone_gives_a_model_that_can_be_saved(name: str, tmp_path: Path) -> None:
    model = fit(OPTIONS[name])
    scene = planar(draw_scene(TASKS[2], np.random.default_rng(1)))
    path = model.reproduce(scene)
    assert np.linalg.norm(path.mean[0] - scene["start"].position) < 0.15
    model.save(tmp_path / "model.npz")
    again = TaskParameterisedGMM.load(tmp_path / "model.npz")
    assert_allclose(again.reproduce(scene).mean, path.mean, atol=0)
    assert again.explain() == model.explain()


def test_looking_along_the_sequence_helps_rings() -> None:
    kernel = replace(PAPER, encode=Encode.KERNEL)
    assert error(replace(kernel, ring_direction=RingDirection.SEQUENCE)) < error(kernel)


def test_the_approach_angle_helps_further() -> None:
    sequence = replace(PAPER, encode=Encode.KERNEL, ring_direction=RingDirection.SEQUENCE)
    assert error(replace(sequence, approach_angle=True)) < error(sequence)


def test_the_improved_method_beats_all_products() -> None:
    assert error(IMPROVED) < 0.7 * error(PAPER)


def test_tracking_takes_jerk_out() -> None:
    scenes = [planar(draw_scene(TASKS[2], np.random.default_rng(i))) for i in range(10)]
    rough, smooth = (
        np.stack([p.mean for p in fit(replace(PAPER, jerk_weight=w)).reproduce_many(scenes)])
        for w in (0.0, 1e-6)
    )
    assert log_dimensionless_jerk(smooth) < log_dimensionless_jerk(rough) - 2


def test_the_chosen_number_of_gaussians_is_told() -> None:
    model = fit(replace(PAPER, component_choices=(1, 5)))
    assert "5 Gaussians predict left-out demonstrations best" in model.explain()
    generator = model.generator
    assert isinstance(generator, FrameProduct)
    assert generator.encoding.profile(np.array([0.5])).mean.shape == (2, 1, 2)


def test_method_names_stand_for_settings() -> None:
    assert settings_for("conventional") is CONVENTIONAL
    with pytest.raises(ValueError, match="no method named 'ring'; choose one of"):
        settings_for("ring")


def test_scikit_learns_argument_names_reach_the_mixture() -> None:
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="component")
        model = TaskParameterisedGMM.fit(demos(), method="conventional", n_components=3, max_iter=2, tol=0.0)
    assert "3 Gaussians, 2 iterations, stopped without converging" in model.explain()


def test_arguments_of_mixtures_without_effect_are_told() -> None:
    with pytest.warns(UserWarning, match="n_components, tol has no effect: these settings fit no Gaussian"):
        TaskParameterisedGMM.fit(demos(), n_components=3, tol=1e-3)


def test_warping_is_chosen_where_it_helps_and_told() -> None:
    kernel = replace(PAPER, encode=Encode.KERNEL, alignment=Alignment.CHOSEN)
    assert "Warped to one timing the demonstrations do" in fit(kernel).explain()


def test_without_a_way_to_tell_paths_settings_are_refused() -> None:
    with pytest.raises(ValueError, match="told_by is empty; choose of: WAY, TIME, WARP"):
        replace(IMPROVED.course, told_by=())


def test_a_negative_regularisation_is_refused() -> None:
    with pytest.raises(ValueError, match="tol and reg_covar must not be negative"):
        TaskParameterisedGMM.fit(demos(), method="paper", reg_covar=-1.0)
