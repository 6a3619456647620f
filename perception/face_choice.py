"""Which fits are believed, which face each place belongs to, and what is said of the others."""

from collections.abc import Sequence

import numpy as np

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.detection import Detection, NotSeen
from perception.face_fit import FaceFit
from perception.rigid import on_plane

_LEAST_SHOWN = 0.35  # Share of a face's pixels that must look as they should.
# Of their brightness with the expected. Noisy, blurred or covered, the right face was never below 0.95 and
# something else never above 0.82, in 200 pictures of a benchmark.
_LEAST_CORRELATION = 0.88
_CERTAIN = 0.7  # Evidence from which on no other places are tried: 90 % correlation of nearly all.
_PERFECT = 0.99  # Higher correlations tell nothing more.
_SAME_PLACE = 0.3  # Two poses closer than this share of a face's size are one object.


def is_certain(fit: FaceFit) -> bool:
    """Whether no better place needs to be looked for."""
    return not _fault(fit) and _evidence(fit) > _CERTAIN


def contour(appearance: Appearance, fit: FaceFit, camera: Camera) -> Array:
    """Where the outline of a face lands in the picture [px], shape (n, 2)."""
    return camera.project(on_plane(fit.frame.apply(appearance.outline), appearance.z))


def share(groups: Sequence[Sequence[Appearance]], tried: Sequence[Sequence[FaceFit]]) -> list[list[FaceFit]]:
    """For each group of faces that look the same the fits that it keeps: each place goes to the best fit.

    Args:
        groups: The faces.
        tried: The fits of each group's face.
    """
    kept: list[tuple[int, FaceFit]] = []
    candidates = [(i, fit) for i, fits in enumerate(tried) for fit in fits if not _fault(fit)]
    for i, fit in sorted(candidates, key=lambda candidate: -_evidence(candidate[1])):
        room = _SAME_PLACE * float(np.ptp(groups[i][0].outline, axis=0).min())
        near = any(np.linalg.norm(other.frame.position - fit.frame.position) < room for _, other in kept)
        if not near and sum(j == i for j, _ in kept) < len(groups[i]):
            kept.append((i, fit))
    return [[fit for j, fit in kept if j == i] for i in range(len(groups))]


def told(
    group: Sequence[Appearance], camera: Camera, tried: Sequence[FaceFit], kept: Sequence[FaceFit]
) -> dict[str, Detection | NotSeen]:
    """What is said of the objects that look the same, by their names, from left to right."""
    ordered = sorted(kept, key=lambda fit: -fit.frame.position[1])
    said: dict[str, Detection | NotSeen] = {
        each.name: _detection(each, camera, fit) for each, fit in zip(group, ordered, strict=False)
    }
    for each in group[len(ordered) :]:
        said[each.name] = NotSeen(each.name, _reason(each.name, tried))
    return said


def _reason(name: str, tried: Sequence[FaceFit]) -> str:
    """Why a face is not seen of which these fits were tried, none of which is left for it."""
    if not tried:
        return f"nothing in the picture looks like the {name}."
    faults = [fault for fit in sorted(tried, key=_evidence, reverse=True) if (fault := _fault(fit))]
    return faults[0] if faults else "what looks most like it is another object."


def _evidence(fit: FaceFit) -> float:
    """What the picture tells of the face: mutual information of expected and seen, per pixel of it [nat]."""
    return -0.5 * fit.shown * float(np.log(1.0 - np.clip(fit.correlation, 0.0, _PERFECT) ** 2))


def _fault(fit: FaceFit) -> str:
    """Why a fit is not to be believed; empty if it is."""
    if fit.shown < _LEAST_SHOWN:
        shown = f"{100 * fit.shown:.0f} %"
        return f"only {shown} of its face looks as it should; it is covered, or something else."
    if fit.correlation < _LEAST_CORRELATION:
        return f"what looks most like it differs from it (correlation {fit.correlation:.2f})."
    return ""


def _detection(appearance: Appearance, camera: Camera, fit: FaceFit) -> Detection:
    return Detection(
        name=appearance.name,
        frame=fit.frame,
        symmetry=1,
        covariance=fit.covariance,
        confidence=fit.shown,
        contour=contour(appearance, fit, camera),
    )
