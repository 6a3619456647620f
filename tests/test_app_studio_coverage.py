"""The next scene: one where the model is unsure; at first, one that is far from what was shown."""

import numpy as np

from cobot_lfd.app.studio.coverage import suggest_next
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.learning.suggestion import suggest_demonstration
from scenes import load_scene
from scenes.placement import draw_placements

SCENE = load_scene("pick_and_place")
N_SCENES = 60


def demonstration(seed: int) -> Demonstration:
    """A path from the cube to the container, bent a little."""
    layout = draw_placements(SCENE, np.random.default_rng(seed))
    start, end = layout["cube"].position, layout["container"].position
    share = np.linspace(0.0, 1.0, 100)[:, None]
    bend = 0.05 * np.sin(np.pi * share) * np.array([1.0, 0.0])
    return Demonstration(start + share * (end - start) + bend, dict(layout), np.linspace(0.0, 3.0, 100))


def test_before_anything_was_shown_any_scene_is_as_good() -> None:
    following = suggest_next(SCENE, 7, [])
    assert (following.seed, "any scene" in following.reason) == (7, True)


def test_after_one_demonstration_the_scene_is_far_from_it() -> None:
    """Farther than nearly all others: positions alone do not decide, directions count as well."""
    shown = demonstration(0)
    following = suggest_next(SCENE, 1, [shown])

    def away(seed: int) -> float:
        layout = draw_placements(SCENE, np.random.default_rng(seed))
        return sum(
            float(np.linalg.norm(layout[name].position - shown.frames[name].position)) for name in layout
        )

    chosen, others = away(following.seed), [away(seed) for seed in range(1, 1 + N_SCENES)]
    assert chosen >= np.quantile(others, 0.8)
    assert "from wherever it was shown" in following.reason


def test_with_two_demonstrations_the_model_is_asked() -> None:
    shown = [demonstration(0), demonstration(1)]
    following = suggest_next(SCENE, 2, shown)
    model = TaskParameterisedGMM.fit(shown)
    candidates = [draw_placements(SCENE, np.random.default_rng(seed)) for seed in range(2, 2 + N_SCENES)]
    expected = suggest_demonstration(model, candidates, [one.frames for one in shown])
    assert following.seed == 2 + expected.index
    assert f"the path to about {1000 * expected.uncertainty:.0f} mm" in following.reason


def test_the_suggestion_is_the_same_every_time() -> None:
    shown = [demonstration(seed) for seed in range(3)]
    assert suggest_next(SCENE, 3, shown) == suggest_next(SCENE, 3, shown)
