"""cobot-lfd demos: what the command prints and how it ends."""

from pathlib import Path

import pytest

from cobot_lfd.app.cli import main
from cobot_lfd.app.demonstrations.store import list_episodes, save_episode
from cobot_lfd.outcome import Outcome
from tests.app_examples import episode


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with two episodes that succeeded and one that did not."""
    for seed in (10, 11, 12):
        save_episode(tmp_path / "d", episode(seed, Outcome.SUCCESS if seed < 12 else Outcome.INCOMPLETE))
    return tmp_path / "d"


def test_list_has_a_line_per_demonstration(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demos", "list", str(folder)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 4
    assert "seed 11" in lines[1]
    assert "the recording was stopped before its end" in lines[2]
    assert lines[3].startswith("3 demonstrations in")


def test_show_plots(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demos", "show", str(folder), "0", "--plot", str(tmp_path / "p.png")]) == 0
    assert "frame cube: (0.5000, 0.1000) m, 17.2 degrees" in capsys.readouterr().out
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    assert main(["demos", "show", str(folder), "0", "--plot", str(tmp_path / "p.xyz")]) == 2
    assert "its name must end in one of: .pdf, .png, .svg" in capsys.readouterr().err


def test_trash_restore_and_check(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demos", "trash", str(folder), "0", "2"]) == 0
    assert len(list_episodes(folder)) == 1
    assert main(["demos", "restore", str(folder), "2"]) == 0
    assert main(["demos", "check", str(folder)]) == 0
    assert "3 of 3 files are whole" in capsys.readouterr().out
    damaged = list_episodes(folder)[0]
    damaged.write_bytes(damaged.read_bytes()[:-1])
    assert main(["demos", "check", str(folder)]) == 1
    assert "is damaged" in capsys.readouterr().out
    assert main(["demos", "list", str(folder)]) == 1
    assert "is damaged" in capsys.readouterr().out


def test_a_number_that_is_not_there_is_told_in_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["demos", "show", str(folder), "7"]) == 2
    [line] = capsys.readouterr().err.splitlines()
    assert line.endswith("choose one of: 0, 1, 2.")


def test_export_leaves_out_what_failed_unless_asked(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    export = ["demos", "export", str(folder), "--to", "robomimic", "--out"]
    assert main([*export, str(tmp_path / "a.hdf5")]) == 0
    assert main([*export, str(tmp_path / "b.hdf5"), "--failed"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("2 of 3 demonstrations")
    assert lines[1].startswith("3 of 3 demonstrations")


def test_import_adds_to_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "p.csv").write_text("t,x,y\n0,0.5,0.1\n1,0.6,0.1\n2,0.6,-0.2\n")
    (tmp_path / "f.toml").write_text("[frames.cube]\nposition = [0.5, 0.1]\n")
    arguments = ["--frames", str(tmp_path / "f.toml"), "--out", str(tmp_path / "new"), "--scene", "s"]
    assert main(["demos", "import", str(tmp_path / "p.csv"), *arguments]) == 0
    assert main(["demos", "list", str(tmp_path / "new")]) == 0
    assert "as imported from p.csv; not seen by the physics" in capsys.readouterr().out
    assert main(["demos", "replay", str(tmp_path / "new"), "0"]) == 2
    assert "has no joint states" in capsys.readouterr().err
