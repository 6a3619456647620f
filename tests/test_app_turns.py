"""How a tool may be turned: what the task says, the most comfortable first."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.app.turns import turn_choices
from cobot_lfd.frame import Frame
from scenes import Task, load_scene

FRAMES = {"peg": Frame(np.array([0.5, -0.2]), 1.9), "slot": Frame(np.array([0.5, 0.2]), -2.6)}
PEG = load_scene("peg_in_slot").task


def changed(**changes: object) -> Task:
    return PEG.model_copy(update=changes)


def test_start_and_end_follow_their_frames() -> None:
    choices = turn_choices(PEG, FRAMES)
    assert len(choices) == 4
    for choice in choices:
        assert_allclose(np.sin(choice.start - 1.9), 0.0, atol=1e-12)  # a half turn does as well
        assert_allclose(np.sin(choice.end + 2.6), 0.0, atol=1e-12)
        assert abs(choice.end - choice.start) <= np.pi


@pytest.mark.parametrize("preferred", [-1.0, 0.0, 2.0])
def test_the_first_choice_asks_least_of_the_wrist(preferred: float) -> None:
    choices = turn_choices(PEG, FRAMES, preferred)
    effort = [abs(c.start - preferred) + abs(c.end - preferred) for c in choices]
    assert effort == sorted(effort)


def test_a_free_end_keeps_the_yaw_of_the_start() -> None:
    for choice in turn_choices(changed(end_yaw=None), FRAMES):
        assert choice.start == choice.end
        assert_allclose(np.sin(choice.start - 1.9), 0.0, atol=1e-12)


def test_a_task_that_leaves_the_yaw_free_begins_with_the_preferred_one() -> None:
    choices = turn_choices(changed(start_yaw=None, end_yaw=None), FRAMES, 0.7)
    assert choices[0].start == choices[0].end == pytest.approx(0.7)
    assert len({choice.start for choice in choices}) == len(choices) > 3
