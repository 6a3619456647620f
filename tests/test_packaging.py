"""What is installed is this tree, whole, and importing it does no more than it must."""

import json
import subprocess
import sys
from importlib.metadata import distribution
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest
from hatchling.builders.wheel import WheelBuilder

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("cobot_lfd", "robots", "scenes", "perception")

FIND_PACKAGE = """
import sys
from importlib.util import find_spec
print(find_spec(sys.argv[1]).origin)
"""

IMPORT_THE_CORE = """
import json, pkgutil, sys
socket_events = []
sys.addaudithook(lambda event, _: socket_events.append(event) if event.startswith("socket.") else None)
import cobot_lfd
for module in pkgutil.walk_packages(cobot_lfd.__path__, "cobot_lfd."):
    if not module.name.startswith(("cobot_lfd.app", "cobot_lfd.__main__")):
        __import__(module.name)
print(json.dumps({"modules": sorted(sys.modules), "socket_events": socket_events}))
"""

OPEN_A_SOCKET = """
import socket, sys
sys.addaudithook(lambda event, _: print(event) if event.startswith("socket.") else None)
socket.socket().close()
"""


def run_elsewhere(code: str, *arguments: str, cwd: Path) -> str:
    """What a fresh interpreter prints that sees installed packages only, not its working folder."""
    command = [sys.executable, "-I", "-c", code, *arguments]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=True).stdout


def installed_root() -> Path:
    """The checkout that the environment's editable install points to; of several worktrees, one is it."""
    source = json.loads(distribution("cobot-lfd").read_text("direct_url.json") or "{}")
    return Path(url2pathname(urlsplit(source["url"]).path))


@pytest.fixture(scope="module")
def wheel_files() -> set[str]:
    """The files that the wheel's configuration includes, relative to the project's root."""
    return {included.relative_path for included in WheelBuilder(str(ROOT)).recurse_included_files()}


@pytest.mark.parametrize("package", PACKAGES)
def test_each_import_name_means_our_own_package(package: str, tmp_path: Path) -> None:
    """Packages named robots and scenes exist elsewhere; ours must be the ones that are found."""
    origin = Path(run_elsewhere(FIND_PACKAGE, package, cwd=tmp_path).strip())
    assert origin == installed_root() / package / "__init__.py"


@pytest.mark.parametrize("pattern", ["*.py", "*.toml", "py.typed"])
def test_every_source_and_description_is_in_the_wheel(pattern: str, wheel_files: set[str]) -> None:
    wanted = {
        path.relative_to(ROOT).as_posix() for package in PACKAGES for path in (ROOT / package).rglob(pattern)
    }
    assert wanted
    assert wanted <= wheel_files


def test_the_wheel_holds_nothing_but_the_four_packages(wheel_files: set[str]) -> None:
    assert {Path(file).parts[0] for file in wheel_files} == set(PACKAGES)


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """What importing all of the core, without app, has loaded and opened."""
    output: dict[str, list[str]] = json.loads(
        run_elsewhere(IMPORT_THE_CORE, cwd=tmp_path_factory.mktemp("elsewhere"))
    )
    return output


@pytest.mark.parametrize(
    "library", ["pybullet", "cv2", "matplotlib", "robots", "scenes", "perception", "h5py"]
)
def test_importing_the_core_does_not_import(library: str, imported: dict[str, list[str]]) -> None:
    assert library not in imported["modules"]


def test_importing_the_core_opens_no_socket(imported: dict[str, list[str]]) -> None:
    assert imported["socket_events"] == []
    assert "cobot_lfd.learning" in imported["modules"]


def test_a_socket_would_be_noticed(tmp_path: Path) -> None:
    assert "socket.__new__" in run_elsewhere(OPEN_A_SOCKET, cwd=tmp_path)
