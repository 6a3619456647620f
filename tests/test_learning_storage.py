"""Model files: versioned, whole, and nothing in them is executed."""

import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd import TaskParameterisedGMM
from cobot_lfd.errors import ModelError
from cobot_lfd.learning.experiments.synthetic import TASKS, demonstrations


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("models") / "model.npz"
    TaskParameterisedGMM.fit(demonstrations(TASKS[2], 4, np.random.default_rng(0))).save(path)
    return path


def changed(saved: Path, tmp_path: Path, **changes: object) -> Path:
    """A copy of the model whose header was tampered with."""
    with np.load(saved) as file:
        arrays = {name: file[name] for name in file.files}
    header = json.loads(str(arrays.pop("header"))) | changes
    path = tmp_path / "changed.npz"
    np.savez(path, header=np.array(json.dumps(header)), **arrays)
    return path


def test_an_unknown_version_is_refused_by_name(saved: Path, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="is a model of version 99; this program reads version"):
        TaskParameterisedGMM.load(changed(saved, tmp_path, version=99))


def test_another_programs_file_is_refused(saved: Path, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="is no model file of cobot_lfd"):
        TaskParameterisedGMM.load(changed(saved, tmp_path, format="other"))


def test_a_class_that_is_no_part_of_a_model_is_refused(saved: Path, tmp_path: Path) -> None:
    foreign = {"class": "Popen", "fields": {"args": "true"}}
    with pytest.raises(ModelError, match="damaged: 'Popen'"):
        TaskParameterisedGMM.load(changed(saved, tmp_path, model=foreign))


def test_a_model_that_makes_no_path_is_refused(saved: Path, tmp_path: Path) -> None:
    with np.load(saved) as file:
        header = json.loads(str(file["header"]))
    header["model"]["fields"]["dimension"] = 3
    with pytest.raises(ModelError, match="its parts do not fit together"):
        TaskParameterisedGMM.load(changed(saved, tmp_path, model=header["model"]))


def test_pickled_objects_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "evil.npz"
    content = io.BytesIO()
    np.save(content, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("header.npy", content.getvalue())
    with pytest.raises(ModelError, match="damaged or no model file"):
        TaskParameterisedGMM.load(path)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_a_file_cut_short_anywhere_is_refused(saved: Path, tmp_path: Path, share: float) -> None:
    content = saved.read_bytes()
    path = tmp_path / "short.npz"
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(ModelError, match="damaged"):
        TaskParameterisedGMM.load(path)


def test_saving_twice_writes_the_same_model(saved: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.npz"
    TaskParameterisedGMM.load(saved).save(again)
    with np.load(saved) as first, np.load(again) as second:
        assert first.files == second.files
        assert all((first[name] == second[name]).all() for name in first.files)
