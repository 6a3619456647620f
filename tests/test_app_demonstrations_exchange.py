"""Import and export: what was written is what was recorded, as read by other code."""

import json
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.demonstrations.exchange.importing import import_path
from cobot_lfd.app.demonstrations.exchange.lerobot import export_lerobot
from cobot_lfd.app.demonstrations.exchange.robomimic import export_robomimic
from cobot_lfd.app.demonstrations.store import load_demonstrations, save_episode
from cobot_lfd.arrays import Array
from cobot_lfd.errors import DataError, DescriptionError
from cobot_lfd.learning.model import TaskParameterisedGMM
from tests.app_examples import episode

FRAMES = """
[frames.cube]
position = [0.5, 0.1]
angle_deg = 90
[frames.container]
position = [0.6, -0.2]
"""


@pytest.fixture
def frames(tmp_path: Path) -> Path:
    file = tmp_path / "frames.toml"
    file.write_text(FRAMES)
    return file


def write_csv(file: Path, shift: float = 0.0) -> Path:
    t = np.linspace(0.0, 2.0, 60)
    table = np.column_stack([t, 0.5 + 0.05 * t + shift, 0.1 - 0.15 * t])
    np.savetxt(file, table, delimiter=",", header="t,x,y", comments="")
    return file


def test_a_path_and_its_frames_become_a_demonstration(tmp_path: Path, frames: Path) -> None:
    demonstration = import_path(write_csv(tmp_path / "a.csv"), frames, "pick_and_place").demonstration()
    assert_allclose(demonstration.path[[0, -1]], [[0.5, 0.1], [0.6, -0.2]])
    assert_allclose(demonstration.frames["cube"].angle, np.pi / 2)
    assert_allclose(demonstration.frames["container"].position, [0.6, -0.2])


def test_csv_and_npz_say_the_same(tmp_path: Path, frames: Path) -> None:
    from_csv = import_path(write_csv(tmp_path / "a.csv"), frames, "s")
    x, y = from_csv.tool_positions[:, 0], from_csv.tool_positions[:, 1]
    np.savez(tmp_path / "a.npz", t=from_csv.times, x=x, y=y)
    from_npz = import_path(tmp_path / "a.npz", frames, "s")
    assert_array_equal(from_npz.tool_positions, from_csv.tool_positions)
    assert_array_equal(from_npz.times, from_csv.times)


def test_a_model_learns_from_imported_paths(tmp_path: Path, frames: Path) -> None:
    for i in range(3):
        file = write_csv(tmp_path / f"{i}.csv", shift=0.002 * i)
        save_episode(tmp_path / "demos", import_path(file, frames, "pick_and_place"))
    demonstrations = load_demonstrations(tmp_path / "demos")
    path = TaskParameterisedGMM.fit(demonstrations).reproduce(demonstrations[1].frames).mean
    assert_allclose(path[[0, -1]], demonstrations[1].path[[0, -1]], atol=0.01)  # [m]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,x\n0,1\n", r"has no column y; it needs t, x, y and may have z, qx"),
        ("t,x,y\n0,1,north\n", "is no table of numbers below a header"),
        ("t,x,y\n0,1\n", "names 3 columns and has 2"),
        ("t,x,y\n1,0,0\n0,1,1\n", "holds no path: times must be strictly increasing"),
    ],
)
def test_a_faulty_path_is_told(tmp_path: Path, frames: Path, text: str, message: str) -> None:
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises(DataError, match=message):
        import_path(tmp_path / "bad.csv", frames, "s")


def test_a_missing_or_foreign_path_is_told(tmp_path: Path, frames: Path) -> None:
    with pytest.raises(DataError, match=r"cannot read .*none\.csv: No such file"):
        import_path(tmp_path / "none.csv", frames, "s")
    with pytest.raises(DataError, match=r"must be a \.csv or \.npz file"):
        import_path(tmp_path / "path.xlsx", frames, "s")


def test_faulty_frames_are_told(tmp_path: Path) -> None:
    (tmp_path / "frames.toml").write_text("[frames.cube]\nangle_deg = 3\n")
    with pytest.raises(DescriptionError, match=r"frames\.cube\.position: is missing"):
        import_path(write_csv(tmp_path / "a.csv"), tmp_path / "frames.toml", "s")


def integrated(start: Array, quaternion: Array, actions: Array) -> tuple[Array, Array]:
    """Where the actions lead: each moves and turns the tool."""
    rotation, position = Rotation.from_quat(quaternion), start.copy()
    for action in actions[:-1]:
        position = position + action[:3]
        rotation = Rotation.from_rotvec(action[3:6]) * rotation
    return position, rotation.as_matrix()


def steady(seed: int) -> RecordedEpisode:
    """An episode of 50 samples at 25 Hz."""
    return replace(episode(seed), times=np.arange(50) / 25)


def turning() -> RecordedEpisode:
    """An episode whose tool turns, too."""
    made = steady(5)
    turns = Rotation.from_rotvec(np.linspace([3.0, 0.0, 0.0], [2.5, 0.5, 0.2], len(made.times)))
    return replace(made, tool_quaternions=turns.as_quat())


def test_robomimic_reads_back_what_was_recorded(tmp_path: Path) -> None:
    episodes = [turning(), steady(6)]
    total = export_robomimic(episodes, tmp_path / "demos.hdf5")
    with h5py.File(tmp_path / "demos.hdf5", "r") as file:
        assert file["data"].attrs["total"] == total == 100
        assert json.loads(file["data"].attrs["env_args"])["env_name"] == "pick_and_place"
        assert list(file["mask/train"][()]) == [b"demo_0", b"demo_1"]
        for demo, original in zip(file["data"].values(), episodes, strict=True):
            assert demo.attrs["num_samples"] == len(demo["actions"]) == 50
            assert_array_equal(demo["obs/robot0_joint_pos"], original.joint_positions)
            assert_array_equal(demo["next_obs/robot0_eef_pos"][:-1], original.tool_positions[1:])
            assert_array_equal(np.flatnonzero(demo["dones"]), [49])
            assert demo["rewards"][()].sum() == 1.0
            assert demo["states"].shape == (50, 15)
            position, _ = integrated(
                original.tool_positions[0], original.tool_quaternions[0], demo["actions"][()]
            )
            assert_allclose(position, original.tool_positions[-1])
        _, rotation = integrated(
            np.zeros(3), episodes[0].tool_quaternions[0], file["data/demo_0/actions"][()]
        )
        assert_allclose(rotation, Rotation.from_quat(episodes[0].tool_quaternions[-1]).as_matrix(), atol=1e-9)


def test_lerobot_reads_back_what_was_recorded(tmp_path: Path) -> None:
    """Read with pyarrow's data set interface, which the writer does not use, by the paths in info.json."""
    dataset = pytest.importorskip("pyarrow.dataset")
    folder, episodes = tmp_path / "lerobot", [steady(5), steady(6)]
    assert export_lerobot(episodes, folder, task="pick and place") == 100
    info = json.loads((folder / "meta/info.json").read_text())
    assert (info["codebase_version"], info["fps"], info["total_frames"]) == ("v3.0", 25, 100)
    file = folder / info["data_path"].format(chunk_index=0, file_index=0)
    data = dataset.dataset(file).to_table().to_pydict()
    assert set(data) == set(info["features"])
    places = dataset.dataset(folder / "meta/episodes").to_table().to_pylist()
    for place, original in zip(places, episodes, strict=True):
        rows = slice(place["dataset_from_index"], place["dataset_to_index"])
        state = np.array(data["observation.state"][rows])
        assert_allclose(state[:, :7], original.joint_positions, rtol=1e-6)
        assert_allclose(state[:, 7:10], original.tool_positions, rtol=1e-6)
        assert set(data["episode_index"][rows]) == {place["episode_index"]}
        assert_allclose(data["timestamp"][rows], np.arange(50) / 25, rtol=1e-6)
        assert place["tasks"] == ["pick and place"]
    for name, feature in info["features"].items():
        assert np.array(data[name]).reshape(100, -1).shape[1] == feature["shape"][0]
        assert feature["names"] is None or len(feature["names"]) == feature["shape"][0]
    stats = json.loads((folder / "meta/stats.json").read_text())
    assert_allclose(stats["action"]["mean"], np.mean(data["action"], axis=0), atol=1e-6)


def test_lerobot_does_not_write_over_a_folder(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="is there already; name a new folder"):
        export_lerobot([episode()], tmp_path, task="t")
