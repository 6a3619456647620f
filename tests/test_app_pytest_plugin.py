"""The pytest plugin: five lines test a scene, and a failure says what happened and how to see it again."""

import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from cobot_lfd.app.pytest_plugin import TestedEpisode
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.learning.model import TaskParameterisedGMM

pytestmark = pytest.mark.simulator

OWN_TEST = """
import pathlib
import pytest


@pytest.fixture(scope="module")
def model_file():
    return pathlib.Path("MODEL")


def test_the_task_is_done(episode):
    assert episode(seed=1000, covered=True).succeeded
"""


def test_the_task_is_done(episode: Callable[..., TestedEpisode]) -> None:
    assert episode(seed=1000).succeeded


def test_the_fixtures_belong_together(
    demonstrations: list[Demonstration], model: TaskParameterisedGMM, scene: str, robot: str
) -> None:
    assert (scene, robot, len(demonstrations)) == ("pick_and_place", "panda", 6)
    assert set(model.frame_kinds) <= set(demonstrations[0].frames)


def test_a_failure_says_how_it_ended_and_how_to_see_it_again(
    pytester: pytest.Pytester, model_file: Path
) -> None:
    """A session of its own, in which a test fails because the camera's lens is covered."""
    pytester.makepyfile(OWN_TEST.replace("MODEL", str(model_file)))
    outcome = pytester.runpytest_subprocess("-p", "cobot_lfd.app.pytest_plugin", "-W", "ignore")
    outcome.assert_outcomes(failed=1)
    outcome.stdout.fnmatch_lines(
        [
            "*episodes that did not succeed*",
            "seed 1000: the camera does not see an object that the task needs: *",
            "*seed_1000.png",
            "*cobot-lfd run *model.npz --scene pick_and_place --robot panda --seed 1000 --covered",
        ]
    )
    picture = next(line for line in outcome.outlines if line.strip().endswith("seed_1000.png"))
    assert Path(picture.strip()).exists()


def test_pytest_finds_the_plugin_where_the_package_is_installed() -> None:
    root = Path(__file__).parents[1]
    entry_points = tomllib.loads((root / "pyproject.toml").read_text())["project"]["entry-points"]
    assert entry_points["pytest11"] == {"cobot_lfd.app.pytest_plugin": "cobot_lfd.app.pytest_plugin"}
