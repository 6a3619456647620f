"""The steps of a fit, by the settings."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cobot_lfd.errors import DataError
from cobot_lfd.frame import FrameKind
from cobot_lfd.learning.course.course import Course, fit_course
from cobot_lfd.learning.course.phase import follow
from cobot_lfd.learning.data import TaskData, TaskDemonstration, collect
from cobot_lfd.learning.kinds.criteria import fulfilled
from cobot_lfd.learning.kinds.identification import Certainty, Finding, identify_by_bearing
from cobot_lfd.learning.mixtures.em import EMFit, fit_mixture
from cobot_lfd.learning.mixtures.encoding import Encoding, MixtureEncoding, fit_rings, tabulate
from cobot_lfd.learning.product.approach import learn_approach
from cobot_lfd.learning.product.frame_product import FrameProduct
from cobot_lfd.learning.product.gather import find_visits, ring_directions
from cobot_lfd.learning.selection import select_frames
from cobot_lfd.learning.settings import (
    Alignment,
    Encode,
    Generator,
    Identifier,
    LearningSettings,
    RingDirection,
)
from cobot_lfd.learning.warping import warp_together

N_STEPS = 200
"""Steps to which recordings are brought, except for mixtures, which use every sample."""


@dataclass(frozen=True, slots=True, eq=False)
class Learnt:
    """All that a fit finds out."""

    findings: Sequence[Finding]
    used_frames: tuple[str, ...]
    generator: FrameProduct | Course
    notes: Sequence[str]
    duration: float
    dimension: int


def learn(
    demonstrations: Sequence[TaskDemonstration], settings: LearningSettings, rng: np.random.Generator
) -> Learnt:
    """From demonstrations to a generator.

    Args:
        demonstrations: The demonstrations.
        settings: All choices.
        rng: For k-means initialisation only.

    Raises:
        DataError: If the frames differ by name, or nothing moves.
        ValueError: If a frame is named whose kind is known, and there is none.
    """
    mixtures = settings.generator is Generator.PRODUCT and settings.encode is Encode.MIXTURE
    data = collect(demonstrations, None if mixtures else N_STEPS)
    if data.scale <= np.finfo(float).eps * max(1.0, float(np.abs(data.paths).max())):
        raise DataError("no demonstration moves; record paths that go somewhere.")
    findings = with_known_kinds(identify(data, settings, rng), settings)
    oriented = [finding.kind is FrameKind.ORIENTED for finding in findings]
    used = select_frames(data, oriented) if settings.select_frames else list(range(len(data.names)))
    kept = data.take(used)
    generator, notes = _generator(kept, [oriented[j] for j in used], settings, rng)
    return Learnt(findings, kept.names, generator, notes, data.duration, data.paths.shape[-1])


def identify(data: TaskData, settings: LearningSettings, rng: np.random.Generator) -> list[Finding]:
    """Each frame's kind by the chosen test.

    Args:
        data: The demonstrations.
        settings: Which test, with its thresholds.
        rng: For k-means initialisation only.
    """
    if settings.identifier is Identifier.BEARING:
        return identify_by_bearing(data, settings.bearing)
    if settings.identifier is Identifier.ALL_ORIENTED or len(data.names) == 1:
        reason = "counts as oriented, as conventional mixtures take every frame."
        return [
            Finding(name, FrameKind.ORIENTED, Certainty.ASSUMED, 0.0, f"'{name}' {reason}")
            for name in data.names
        ]
    mixture = fit_mixture(data.local, data.times, settings.em, rng).mixture
    counts = fulfilled(mixture, settings.criteria).sum(axis=0)
    return [
        _by_criteria(name, int(n), len(mixture.weights)) for name, n in zip(data.names, counts, strict=True)
    ]


def _by_criteria(name: str, n_fulfilled: int, n_components: int) -> Finding:
    """One frame's kind by the paper's criteria."""
    kind = FrameKind.ORIENTED if n_fulfilled else FrameKind.ORIENTATION_LESS
    reason = (
        f"'{name}' is {kind.value}: {n_fulfilled} of its {n_components} Gaussians are narrow and stretch "
        "along the path."
    )
    return Finding(name, kind, Certainty.FOUND, 0.0, reason)


def with_known_kinds(findings: list[Finding], settings: LearningSettings) -> list[Finding]:
    """The findings, overruled where the user knows."""
    names = [finding.name for finding in findings]
    unknown = sorted(set(settings.kinds) - set(names))
    if unknown:
        raise ValueError(f"kinds names '{unknown[0]}'; the demonstrations have {', '.join(names)}.")
    return [
        finding
        if finding.name not in settings.kinds
        else Finding(
            finding.name,
            settings.kinds[finding.name],
            Certainty.GIVEN,
            finding.evidence,
            f"'{finding.name}' is {settings.kinds[finding.name].value}, as given.",
        )
        for finding in findings
    ]


def _generator(
    data: TaskData, oriented: list[bool], settings: LearningSettings, rng: np.random.Generator
) -> tuple[FrameProduct | Course, list[str]]:
    """What makes paths, with what there is to say about it."""
    if settings.generator is Generator.COURSE:
        course = fit_course(data, oriented, settings.course)
        return course, course.notes()
    data, notes = _aligned(data, oriented, settings, rng)
    chosen, more = _choose_components(data, oriented, settings, rng)
    product, still_more = _frame_product(data, oriented, chosen, rng)
    return product, [*notes, *more, *still_more]


def _frame_product(
    data: TaskData, oriented: list[bool], settings: LearningSettings, rng: np.random.Generator
) -> tuple[FrameProduct, list[str]]:
    """The paper's generator, with the chosen additions."""
    encoding, notes = _encoding(data, oriented, settings, rng)
    visits = find_visits(data) if settings.ring_direction is RingDirection.SEQUENCE else None
    approach = None
    if settings.approach_angle:
        profile = encoding.profile(data.times)
        looks = {
            ring: ring_directions(profile, data.scenes, oriented, data.times, visits, ring)
            for ring, is_oriented in enumerate(oriented)
            if not is_oriented
        }
        approach = learn_approach(data.paths, data.scenes, oriented, looks)
    return FrameProduct(encoding, tuple(oriented), visits, approach, settings.jerk_weight), notes


def _aligned(
    data: TaskData, oriented: list[bool], settings: LearningSettings, rng: np.random.Generator
) -> tuple[TaskData, list[str]]:
    """The demonstrations with their own timing, or warped to one."""
    if settings.alignment is Alignment.OFF or len(data.paths) < 3:
        return data, []
    warped = warp_together(data)
    if settings.alignment is Alignment.WARP:
        return warped, ["The demonstrations are warped to one timing."]
    errors = [_held_out_error(tried, oriented, settings, rng) for tried in (data, warped)]
    better, told = (warped, "do") if errors[1] < errors[0] else (data, "do not")
    note = (
        f"Warped to one timing the demonstrations {told} predict one another better "
        f"({1000 * errors[1]:.1f} mm, {1000 * errors[0]:.1f} mm without)."
    )
    return better, [note]


def _held_out_error(
    data: TaskData, oriented: list[bool], settings: LearningSettings, rng: np.random.Generator
) -> float:
    """Mean distance of each demonstration from what the others predict, whatever the timing [m]."""
    even = np.linspace(0.0, 1.0, N_STEPS)
    apart = []
    for held_out in range(len(data.paths)):
        product, _ = _frame_product(data.without(held_out), oriented, settings, rng)
        mean, _ = product.generate(data.scenes.only([held_out]), len(data.times))
        both = follow(np.concatenate([mean, data.paths[[held_out]]]), even)
        apart.append(np.linalg.norm(both[0] - both[1], axis=-1).mean())
    return float(np.mean(apart))


def _choose_components(
    data: TaskData, oriented: list[bool], settings: LearningSettings, rng: np.random.Generator
) -> tuple[LearningSettings, list[str]]:
    """The number of Gaussians that predicts left-out demonstrations best."""
    if not settings.component_choices or len(data.paths) < 3:
        return settings, []
    errors = {}
    for k in settings.component_choices:
        tried = replace(settings, em=replace(settings.em, n_components=k))
        apart = []
        for held_out in range(len(data.paths)):
            product, _ = _frame_product(data.without(held_out), oriented, tried, rng)
            mean, _ = product.generate(data.scenes.only([held_out]), len(data.times))
            apart.append(np.linalg.norm(mean[0] - data.paths[held_out], axis=-1).mean())
        errors[k] = float(np.mean(apart))
    best = min(errors, key=errors.__getitem__)
    told = ", ".join(f"{k}: {1000 * error:.1f} mm" for k, error in errors.items())
    note = f"{best} Gaussians predict left-out demonstrations best ({told})."
    return replace(settings, em=replace(settings.em, n_components=best)), [note]


def _encoding(
    data: TaskData, oriented: list[bool], settings: LearningSettings, rng: np.random.Generator
) -> tuple[Encoding, list[str]]:
    """What is known of the path seen from each frame."""
    if settings.encode is Encode.KERNEL:
        table = tabulate(data, settings.kernel_width, settings.em.reg_covar)
        return table, [f"The path seen from each frame is kept at {len(data.times)} times."]
    joint = fit_mixture(data.local, data.times, settings.em, rng)
    less = [j for j, is_oriented in enumerate(oriented) if not is_oriented]
    rings = fit_rings(data, less, settings.em, rng)
    notes = [_fit_note("The mixture", joint)]
    notes += [_fit_note(f"The rings of '{data.names[j]}'", fit) for j, fit in rings.items()]
    return MixtureEncoding(joint.mixture, {j: fit.mixture for j, fit in rings.items()}), notes


def _fit_note(what: str, fit: EMFit) -> str:
    """How a fit went."""
    end = "converged" if fit.converged else "stopped without converging; raise max_iter or tol"
    return (
        f"{what}: {len(fit.mixture.weights)} Gaussians, {fit.n_iterations} iterations, {end}, mean "
        f"log-likelihood {fit.log_likelihood[-1]:.3f}."
    )
