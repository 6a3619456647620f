"""Fixtures for end-to-end tests, from perception to execution: a test of one's own scene in five lines.

Installed with the package, pytest finds them by itself. A module says what it tests in constants of its own::

    COBOT_SCENE = "my_scene.toml"

    def test_the_task_is_done(episode):
        assert episode(seed=1000).succeeded

Where an episode did not succeed in a test that failed, pytest shows how it ended, where its picture is, and
the command that runs it again.
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from cobot_lfd.app.results import EpisodeResult
    from cobot_lfd.demonstration import Demonstration
    from cobot_lfd.learning.model import TaskParameterisedGMM

SCENE, ROBOT, DEMONSTRATIONS = "pick_and_place", "panda", 6
"""What is tested where a module does not say otherwise by COBOT_SCENE, COBOT_ROBOT, COBOT_DEMONSTRATIONS."""

_EPISODES = pytest.StashKey[list["TestedEpisode"]]()


@dataclass(frozen=True, slots=True)
class TestedEpisode:
    """An episode that a test ran.

    Attributes:
        result: What happened.
        picture: What the camera saw, with frames and path.
        command: Runs it again.
    """

    __test__ = False

    result: "EpisodeResult"
    picture: Path
    command: str

    @property
    def succeeded(self) -> bool:
        """Whether the task was done."""
        return self.result.verdict.succeeded

    def told(self) -> str:
        """How it ended, where its picture is, and the command that runs it again."""
        return f"seed {self.result.seed}: {self.result.verdict.sentence}\n  {self.picture}\n  {self.command}"


@pytest.fixture(scope="module")
def scene(request: pytest.FixtureRequest) -> str:
    """Name of the scene, or its file: the module's COBOT_SCENE."""
    return str(getattr(request.module, "COBOT_SCENE", SCENE))


@pytest.fixture(scope="module")
def robot(request: pytest.FixtureRequest) -> str:
    """Name of the robot: the module's COBOT_ROBOT."""
    return str(getattr(request.module, "COBOT_ROBOT", ROBOT))


@pytest.fixture(scope="session")
def _recordings(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, str, int], Path]:
    """Records demonstrations of a scene once for all modules that need them."""
    from cobot_lfd.app.recording.record import record_session

    folders: dict[tuple[str, str, int], Path] = {}

    def record(scene: str, robot: str, n: int) -> Path:
        if (scene, robot, n) not in folders:
            folder = tmp_path_factory.mktemp("demonstrations")
            record_session(scene, robot, folder, n_episodes=n, first_seed=0)
            folders[scene, robot, n] = folder
        return folders[scene, robot, n]

    return record


@pytest.fixture(scope="module")
def demonstrations_folder(
    request: pytest.FixtureRequest, scene: str, robot: str, _recordings: Callable[[str, str, int], Path]
) -> Path:
    """Folder of the demonstrations; the module's COBOT_DEMONSTRATIONS says how many."""
    return _recordings(scene, robot, getattr(request.module, "COBOT_DEMONSTRATIONS", DEMONSTRATIONS))


@pytest.fixture(scope="module")
def demonstrations(demonstrations_folder: Path) -> "list[Demonstration]":
    """Demonstrations of the scene by the scripted hand, recorded in the simulator."""
    from cobot_lfd.app.demonstrations.store import load_demonstrations

    return load_demonstrations(demonstrations_folder)


@pytest.fixture(scope="module")
def model_file(demonstrations_folder: Path, demonstrations: "list[Demonstration]") -> Path:
    """File of a model of the demonstrations, beside them."""
    from cobot_lfd.learning.model import TaskParameterisedGMM

    file = demonstrations_folder / "model.npz"
    if not file.exists():
        TaskParameterisedGMM.fit(demonstrations).save(file)
    return file


@pytest.fixture(scope="module")
def model(model_file: Path) -> "TaskParameterisedGMM":
    """A model of the demonstrations."""
    from cobot_lfd.learning.model import TaskParameterisedGMM

    return TaskParameterisedGMM.load(model_file)


@pytest.fixture
def episode(
    request: pytest.FixtureRequest, scene: str, robot: str, model_file: Path, tmp_path: Path
) -> Callable[..., TestedEpisode]:
    """Runs the episode of a seed: picture, path, motion, and the physics' judgement."""
    from cobot_lfd.app.episode import run_episode
    from cobot_lfd.app.evaluate import Job, bench_for
    from cobot_lfd.app.pictures.draw import save_picture
    from cobot_lfd.app.pictures.illustrate import drawn_view

    def run(seed: int = 1000, *, covered: bool = False) -> TestedEpisode:
        bench = bench_for(Job(scene, robot, model_file, covered))
        done = run_episode(bench, seed)
        drawn = drawn_view(bench.scene, done.view, done.path, detour=done.detour)
        picture = save_picture(drawn, tmp_path / f"seed_{seed}.png")
        command = f"cobot-lfd run {model_file} --scene {scene} --robot {robot} --seed {seed}"
        tested = TestedEpisode(done.result, picture, command + (" --covered" if covered else ""))
        request.node.stash.setdefault(_EPISODES, []).append(tested)
        return tested

    return run


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[Any]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Show the episodes of a test that failed."""
    report = yield
    if call.when == "call" and report.failed:
        told = [tested.told() for tested in item.stash.get(_EPISODES, []) if not tested.succeeded]
        if told:
            report.sections.append(("episodes that did not succeed", "\n".join(told)))
    return report
