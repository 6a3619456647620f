"""Provenance: what is needed to run the same again."""

import hashlib
import json
import subprocess
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

from cobot_lfd.app.provenance import Provenance, file_sha256
from cobot_lfd.errors import DataError

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def collected(tmp_path_factory: pytest.TempPathFactory) -> Provenance:
    model = tmp_path_factory.mktemp("model") / "model.npz"
    model.write_bytes(b"a model")
    return Provenance.collect(
        seeds=range(1000, 1003), options={"method": "improved", "json": True}, model=model
    )


def test_provenance_names_versions_of_the_dependencies(collected: Provenance) -> None:
    assert collected.packages["numpy"] == np.__version__
    assert collected.version == metadata.version("cobot-lfd")
    assert {"pybullet", "opencv-python-headless", "ruckig", "scipy"} <= set(collected.packages)


def test_provenance_names_the_model_by_its_checksum(collected: Provenance) -> None:
    assert collected.model_sha256 == hashlib.sha256(b"a model").hexdigest()


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="not run from a git checkout")
def test_provenance_names_the_commit_of_the_checkout(collected: Provenance) -> None:
    git = subprocess.run(["git", "-C", ROOT, "rev-parse", "HEAD"], capture_output=True, text=True, check=True)
    assert collected.commit == git.stdout.strip()
    assert collected.modified in (True, False)


def test_saved_provenance_can_be_read_as_json(collected: Provenance, tmp_path: Path) -> None:
    collected.save(tmp_path / "provenance.json")
    values = json.loads((tmp_path / "provenance.json").read_text())
    assert values["seeds"] == [1000, 1001, 1002]
    assert values["options"] == {"method": "improved", "json": True}


def test_a_missing_model_is_told(tmp_path: Path) -> None:
    with pytest.raises(
        DataError, match=r"cannot read .*none\.npz: No such file or directory\. Check the name\."
    ):
        file_sha256(tmp_path / "none.npz")


def test_a_missing_folder_is_told(collected: Provenance, tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"cannot write .*provenance\.json: No such file or directory"):
        collected.save(tmp_path / "none" / "provenance.json")
