"""The command line: what it prints, where it puts it, and how it ends."""

import json
import shutil
from pathlib import Path

import cv2
import pytest

from cobot_lfd.app.cli import main
from cobot_lfd.app.demonstrations.store import list_episodes

pytestmark = pytest.mark.simulator


def test_the_four_steps(
    demonstrations_folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Record, fit, run, evaluate; the demonstrations but for one come from the other tests."""
    demos, model = tmp_path / "demos", tmp_path / "models" / "model.npz"
    shutil.copytree(demonstrations_folder, demos)
    assert main(["record", "pick_and_place", "--robot", "panda", "--demos", "1", "--out", str(demos)]) == 0
    assert len(list_episodes(demos)) == 7
    assert main(["fit", str(demos), "--out", str(model)]) == 0
    assert "frame cube: orientation-less" in capsys.readouterr().out
    run = ["run", str(model), "--scene", "pick_and_place", "--seed", "1000"]
    pictures = ["--picture", str(tmp_path / "seen.png"), "--plot", str(tmp_path / "path.png")]
    assert main([*run, *pictures, "--demos", str(demos)]) == 0
    told = capsys.readouterr().out
    for name in ("seen.png", "path.png"):
        assert str(tmp_path / name) in told
        assert cv2.imread(str(tmp_path / name)) is not None
    evaluate = ["evaluate", str(model), "--scene", "pick_and_place", "--episodes", "2", "--seed", "1000"]
    assert main([*evaluate, "--out", str(tmp_path / "run"), "--json"]) == 0
    captured = capsys.readouterr()
    summary = json.loads(captured.out)
    assert (summary["episodes"], summary["successes"], summary["success_rate"]) == (2, 2, 1.0)
    assert "evaluating 2/2: model.npz, seed 100" in captured.err


def test_an_episode_that_fails_gives_exit_code_1(
    model_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["evaluate", str(model_file), "--scene", "pick_and_place", "--episodes", "1", "--covered"]
    assert main([*words, "--out", str(tmp_path / "run")]) == 1
    assert "object_not_seen" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["record", "picking", "--out", "x"], "no scene named 'picking'; choose one of:"),
        (
            ["record", "pick_and_place", "--robot", "ur7", "--out", "x"],
            "no robot named 'ur7'",
        ),
        (["record", "pick_and_place", "--demos", "0", "--out", "x"], "--demos is 0; it must be at least 1."),
        (["fit", "nowhere", "--out", "model.npz"], "there is no folder nowhere"),
        (["run", "none.npz", "--scene", "pick_and_place"], "none.npz"),
        (["look", "--scene", "sorting", "--out", "p.jpg"], "p.jpg: its name must end in .png."),
        (
            ["look", "--scene", "sorting", "--out", "a/p.png"],
            "cannot write a/p.png: No such file or directory.",
        ),
        (
            ["look", "--scene", "sorting", "--out", "p.png", "--seed", "-1"],
            "--seed is -1; it must be at least 0.",
        ),
        (["frames", "demos", "--out", "p.bmp"], "cannot plot to p.bmp: its name must end in one of: .pdf"),
        (
            ["calibrate", "--scene", "sorting", "--out", "c.toml", "--views", "3"],
            "--views is 3; it must be at least 6",
        ),
        (["calibrate", "--scene", "sorting", "--out", "a/c.toml"], "cannot write a/c.toml: No such file"),
    ],
)
def test_a_mistake_is_told_in_one_line_with_exit_code_2(
    words: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    error = capfd.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_scenes_and_robots_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scenes"]) == 0
    assert main(["robots"]) == 0
    listed = capsys.readouterr().out
    assert "pick_and_place: Pick up the cube" in listed
    assert "panda: Franka Emika Panda" in listed
