"""What several files of tests need and what takes long to make: demonstrations and a model of them."""

from pathlib import Path

import pytest

from cobot_lfd.app.record import record_session
from cobot_lfd.app.store import load_demonstrations
from cobot_lfd.learning.model import TaskParameterisedGMM


@pytest.fixture(scope="session")
def demonstrations_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six demonstrations of pick-and-place, recorded in the simulator."""
    folder = tmp_path_factory.mktemp("demos")
    record_session("pick_and_place", "panda", folder, n_episodes=6, first_seed=0)
    return folder


@pytest.fixture(scope="session")
def model_file(demonstrations_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A model of the six demonstrations."""
    file = tmp_path_factory.mktemp("model") / "model.npz"
    TaskParameterisedGMM.fit(load_demonstrations(demonstrations_folder)).save(file)
    return file
