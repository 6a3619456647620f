"""Robot files are checked when they are read; a fault is told with file, key, value and what is allowed."""

from pathlib import Path

import numpy as np
import pytest

import robots.description as description
from cobot_lfd.errors import DescriptionError
from robots import load_robot, robot_names

PANDA = Path(description.__file__).parent / "panda" / "robot.toml"


def load_changed(monkeypatch: pytest.MonkeyPatch, folder: Path, old: str, new: str) -> None:
    """Load the Panda from a copy of its file in which a text is replaced."""
    text = PANDA.read_text()
    assert old in text
    (folder / "panda").mkdir()
    (folder / "panda" / "robot.toml").write_text(text.replace(old, new, 1))
    monkeypatch.setattr(description, "_FOLDER", folder)
    load_robot("panda")


def test_every_robot_loads() -> None:
    assert "panda" in robot_names()
    for name in robot_names():
        assert load_robot(name).joint_limits.n_joints == len(load_robot(name).joints)


def test_the_panda_has_the_limits_of_its_data_sheet() -> None:
    """Franka Control Interface documentation, joint space limits."""
    limits = load_robot("panda").joint_limits
    np.testing.assert_array_equal(limits.velocity, [2.175] * 4 + [2.61] * 3)
    np.testing.assert_array_equal(limits.jerk, [7500, 3750, 5000, 6250, 7500, 10000, 10000])


def test_an_unknown_robot_is_answered_with_the_known_ones() -> None:
    with pytest.raises(DescriptionError, match=r"no robot named 'ur7'; choose one of: .*panda"):
        load_robot("ur7")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("home = [0.0, ", "home = [", r"robot\.toml: home has 6 numbers; it needs one for each of 7 joints"),
        (
            "parked = [0.0",
            "parked = [9.0",
            r"parked: joint 1 is at 9\.0 rad; it can take -2\.8973 to 2",
        ),
        ("force = 20.0", "force = -1.0", r"gripper\.force: input should be greater than 0; given: -1\.0"),
        ("speed = 0.1", "spede = 0.1", r"gripper\.spe(ed|de): "),
        ("title = ", "title = = ", r"is no valid TOML"),
    ],
)
def test_a_fault_in_a_robot_file_is_named(
    old: str, new: str, message: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    with pytest.raises(DescriptionError, match=message):
        load_changed(monkeypatch, tmp_path, old, new)
