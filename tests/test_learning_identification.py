"""Finding the frames' kinds: by bearing, and by the paper's criteria."""

from dataclasses import replace

import numpy as np
import pytest

from cobot_lfd import Demonstration, Frame, FrameKind, TaskParameterisedGMM
from cobot_lfd.learning.data import TaskData, collect
from cobot_lfd.learning.experiments.synthetic import TASKS, SyntheticTask, demonstrations
from cobot_lfd.learning.kinds.bearing import BearingTest, bearing_evidence
from cobot_lfd.learning.kinds.criteria import Criteria, fulfilled
from cobot_lfd.learning.kinds.identification import Certainty, identify_by_bearing
from cobot_lfd.learning.mixtures.mixture import Mixture


def data_of(task: SyntheticTask, seed: int, n: int = 6) -> TaskData:
    return collect(demonstrations(task, n, np.random.default_rng(seed)))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("number", [1, 2, 3])
def test_the_kinds_of_the_papers_tasks_are_found(number: int, dimension: int) -> None:
    task = replace(TASKS[number], dimension=dimension)
    for seed in range(5):
        found = identify_by_bearing(data_of(task, seed), BearingTest())
        assert {f.name: f.kind is FrameKind.ORIENTED for f in found} == task.kinds


def test_evidence_does_not_depend_on_how_frames_axes_are_chosen() -> None:
    """Turning a frame's axes by the same angle in every demonstration changes no evidence."""
    demos = demonstrations(TASKS[2], 5, np.random.default_rng(1))
    turned = []
    for demo in demos:
        assert isinstance(demo, Demonstration)
        start = demo.frames["start"]
        frames = dict(demo.frames) | {"start": Frame(start.position, start.angle + 1.3)}
        turned.append(Demonstration(demo.path, frames))
    first = bearing_evidence(collect(demos), BearingTest())
    second = bearing_evidence(collect(turned), BearingTest())
    np.testing.assert_allclose(first, second, atol=1e-8)


def test_a_frame_that_was_never_turned_is_not_called_certain() -> None:
    """All slots point the same way and so do the lines of sight: nothing can tell axes from sight."""
    line = np.linspace([0.0, 0.0], [1.0, 0.0], 100)
    rng = np.random.default_rng(0)
    demos = []
    for _ in range(2):
        shift = rng.normal(0, 0.1, 2)
        frames = {"a": Frame(shift, 0.0), "b": Frame(shift + np.array([1.0, 0.0]), 0.0)}
        demos.append(Demonstration(line + shift + rng.normal(0, 1e-3, line.shape), frames))
    findings = identify_by_bearing(collect(demos), BearingTest())
    assert all(f.certainty is Certainty.UNDECIDED for f in findings)
    assert "record another demonstration with 'a' turned" in findings[0].reason


def test_an_only_frame_counts_as_oriented() -> None:
    line = np.linspace([0.0, 0.0], [1.0, 0.5], 50)
    demos = [Demonstration(line + s, {"only": Frame(np.array([s, s]), s)}) for s in (0.0, 0.1, 0.2)]
    model = TaskParameterisedGMM.fit(demos)
    assert model.frame_kinds["only"] is FrameKind.ORIENTED
    assert "'only' is the only frame" in model.explain()


def test_a_kind_that_the_user_knows_is_not_put_to_the_test() -> None:
    demos = demonstrations(TASKS[3], 5, np.random.default_rng(0))
    model = TaskParameterisedGMM.fit(demos, frame_kinds={"end": FrameKind.ORIENTED})
    assert model.frame_kinds["end"] is FrameKind.ORIENTED
    assert "'end' is oriented, as given." in model.explain()


def test_a_known_kind_of_an_unknown_frame_is_refused() -> None:
    demos = demonstrations(TASKS[3], 3, np.random.default_rng(0))
    with pytest.raises(ValueError, match="kinds names 'lid'; the demonstrations have start, end"):
        TaskParameterisedGMM.fit(demos, frame_kinds={"lid": FrameKind.ORIENTED})


def gaussian(long: float, short: float, angle: float, flow: tuple[float, float]) -> Mixture:
    """One Gaussian with given variances along and across ``angle``, and covariance of [x, y] with time."""
    axis = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    covariance = np.eye(3)
    covariance[1:, 1:] = axis @ np.diag([long, short]) @ axis.T
    covariance[0, 1:] = covariance[1:, 0] = flow
    return Mixture(np.ones(1), np.zeros((1, 1, 3)), covariance[None, None])


@pytest.mark.parametrize(
    ("long", "angle", "flow", "expected"),
    [
        (10.1, 0.0, (0.5, 0.0), True),
        (9.9, 0.0, (0.5, 0.0), False),
        (20.0, 0.5, (-np.cos(0.5), -np.sin(0.5)), True),
        (20.0, 0.0, (np.cos(0.09), np.sin(0.09)), True),
        (20.0, 0.0, (np.cos(0.11), np.sin(0.11)), False),
        (20.0, 0.0, (0.0, 0.0), False),
    ],
)
def test_the_papers_criteria_are_narrowness_and_direction(
    long: float, angle: float, flow: tuple[float, float], expected: bool
) -> None:
    assert fulfilled(gaussian(long, 1.0, angle, flow), Criteria())[0, 0] == expected
