"""Imports point one way: what each part of the project may see (DESIGN.md's table), read from the sources."""

import ast
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("cobot_lfd", "robots", "scenes", "perception")


@dataclass(frozen=True, slots=True)
class Import:
    """One import in one file.

    Attributes:
        file: The importing file, relative to the project's root, with slashes.
        module: What is imported, as an absolute dotted name.
        at_start: Whether it runs when the file is imported: not in a function, not for type checkers only.
    """

    file: str
    module: str
    at_start: bool

    def of(self, *packages: str) -> bool:
        """Whether the module is one of these packages or lies inside one."""
        return any(self.module == package or self.module.startswith(f"{package}.") for package in packages)

    def within(self, *patterns: str) -> bool:
        """Whether the importing file matches one of these patterns (``*`` matches slashes too)."""
        return any(fnmatch(self.file, pattern) for pattern in patterns)


def read_imports(file: str, source: str) -> list[Import]:
    """All imports of a source file, wherever they stand in it."""
    return [Import(file, module, at_start) for module, at_start in _walk(ast.parse(source), file, True)]


def _walk(node: ast.AST, file: str, at_start: bool) -> Iterator[tuple[str, bool]]:
    if isinstance(node, ast.Import):
        yield from ((alias.name, at_start) for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        base = _absolute(node, file)
        yield from ((f"{base}.{alias.name}", at_start) for alias in node.names)
    elif isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
        yield from _walk_all(node.body, file, False)
        yield from _walk_all(node.orelse, file, at_start)
        return
    elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_quietly"):
        yield from ((str(name.value), at_start) for name in node.args if isinstance(name, ast.Constant))
    later = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
    yield from _walk_all(ast.iter_child_nodes(node), file, at_start and not later)


def _walk_all(nodes: Iterable[ast.AST], file: str, at_start: bool) -> Iterator[tuple[str, bool]]:
    for node in nodes:
        yield from _walk(node, file, at_start)


def _absolute(node: ast.ImportFrom, file: str) -> str:
    """The absolute name of the module that a ``from`` import names."""
    if node.level == 0:
        return node.module or ""
    package = file.split("/")[: -node.level]
    return ".".join([*package, *([node.module] if node.module else [])])


# The rules: each takes one import and says whether it breaks the rule.


def core_sees_outward(found: Import) -> bool:
    """The core is all of cobot_lfd but app, and but the door through which ``python -m cobot_lfd`` enters."""
    in_core = found.within("cobot_lfd/*") and not found.within("cobot_lfd/app/*", "cobot_lfd/__main__.py")
    return in_core and found.of("cobot_lfd.app", "robots", "scenes", "perception")


def middle_sees_sideways_or_up(found: Import) -> bool:
    own = found.file.split("/")[0]
    others = [package for package in ("robots", "scenes", "perception", "cobot_lfd.app") if package != own]
    return own in ("robots", "scenes", "perception") and found.of(*others)


def simulator_outside_its_rooms(found: Import) -> bool:
    return found.of("pybullet", "pybullet_data", "pybullet_utils") and not found.within(
        "robots/*", "scenes/*"
    )


def opencv_outside_its_rooms(found: Import) -> bool:
    allowed = ("perception/*", "cobot_lfd/app/pictures/draw.py", "cobot_lfd/app/pictures/video.py")
    return found.of("cv2") and not found.within(*allowed)


def ruckig_outside_timing(found: Import) -> bool:
    return found.of("ruckig") and not found.within("cobot_lfd/motion/timing*")


def viser_outside_studio(found: Import) -> bool:
    return found.of("viser") and not found.within("cobot_lfd/app/studio*")


def plotting_at_start(found: Import) -> bool:
    return found.of("matplotlib") and found.at_start


def tools_or_tests_imported(found: Import) -> bool:
    return found.of("tools", "tests")


def unknown_plotting(found: Import) -> bool:
    return found.of("matplotlib") and not found.within("cobot_lfd/app/*")


def hidden_import(found: Import) -> bool:
    """Imports that this test could not read.

    The exceptions are the public interface, loaded when it is used, and ``import_quietly``, which is read.
    """
    dynamic = found.module == "importlib" or found.of("importlib.import_module")
    return dynamic and not found.within("cobot_lfd/__init__.py", "cobot_lfd/quiet.py")


@pytest.fixture(scope="module")
def imports() -> list[Import]:
    """Every import of the four packages."""
    files = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
    return [
        found
        for path in files
        for found in read_imports(path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8"))
    ]


def test_the_core_does_not_see_app_robots_scenes_or_perception(imports: list[Import]) -> None:
    assert not [found for found in imports if core_sees_outward(found)]


def test_robots_scenes_and_perception_see_neither_one_another_nor_app(imports: list[Import]) -> None:
    assert not [found for found in imports if middle_sees_sideways_or_up(found)]


def test_only_robots_and_scenes_import_pybullet(imports: list[Import]) -> None:
    assert not [found for found in imports if simulator_outside_its_rooms(found)]


def test_only_perception_drawing_and_video_import_opencv(imports: list[Import]) -> None:
    assert not [found for found in imports if opencv_outside_its_rooms(found)]


def test_only_timing_imports_ruckig(imports: list[Import]) -> None:
    assert not [found for found in imports if ruckig_outside_timing(found)]


def test_only_the_studio_imports_viser(imports: list[Import]) -> None:
    assert not [found for found in imports if viser_outside_studio(found)]


def test_matplotlib_is_imported_late_and_in_app_only(imports: list[Import]) -> None:
    assert not [found for found in imports if plotting_at_start(found) or unknown_plotting(found)]


def test_nothing_imports_tools_or_tests(imports: list[Import]) -> None:
    assert not [found for found in imports if tools_or_tests_imported(found)]


def test_no_import_is_hidden_from_this_test(imports: list[Import]) -> None:
    assert not [found for found in imports if hidden_import(found)]


def test_a_relative_import_is_read_as_the_absolute_one() -> None:
    assert read_imports("robots/arm.py", "from ..scenes import World")[0].module == "scenes.World"


def test_the_sources_are_found(imports: list[Import]) -> None:
    importing = {found.file.split("/")[0] for found in imports}
    assert importing == set(PACKAGES)
    assert any(found.of("pybullet") for found in imports)


@pytest.mark.parametrize(
    ("rule", "file", "source"),
    [
        (core_sees_outward, "cobot_lfd/frame.py", "import robots"),
        (
            core_sees_outward,
            "cobot_lfd/learning/model.py",
            "from cobot_lfd.app.recording.record import lead",
        ),
        (core_sees_outward, "cobot_lfd/learning/model.py", "from cobot_lfd import app"),
        (core_sees_outward, "cobot_lfd/learning/model.py", "from ..app import store"),
        (core_sees_outward, "cobot_lfd/learning/model.py", "from .. import app"),
        (core_sees_outward, "cobot_lfd/__init__.py", "from . import app"),
        (core_sees_outward, "cobot_lfd/frame.py", "def f():\n    from scenes import World"),
        (middle_sees_sideways_or_up, "scenes/world.py", "from robots.arm import Arm"),
        (middle_sees_sideways_or_up, "perception/boxes.py", "import scenes.world as w"),
        (middle_sees_sideways_or_up, "robots/arm.py", "from cobot_lfd.app import store"),
        (middle_sees_sideways_or_up, "robots/panda/x.py", "if TYPE_CHECKING:\n    import perception"),
        (simulator_outside_its_rooms, "cobot_lfd/app/recording/record.py", "import pybullet as p"),
        (simulator_outside_its_rooms, "perception/boxes.py", "from pybullet_utils import bullet_client"),
        (simulator_outside_its_rooms, "cobot_lfd/pose.py", "import pybullet_data"),
        (simulator_outside_its_rooms, "cobot_lfd/pose.py", "import_quietly('pybullet')"),
        (opencv_outside_its_rooms, "cobot_lfd/app/recording/record.py", "import cv2"),
        (opencv_outside_its_rooms, "scenes/view.py", "try:\n    import cv2\nexcept ImportError:\n    pass"),
        (ruckig_outside_timing, "cobot_lfd/motion/path.py", "from ruckig import Ruckig"),
        (viser_outside_studio, "cobot_lfd/app/cli.py", "import viser"),
        (plotting_at_start, "cobot_lfd/app/pictures/plot.py", "import matplotlib.pyplot as plt"),
        (plotting_at_start, "cobot_lfd/app/pictures/plot.py", "class A:\n    from matplotlib import figure"),
        (unknown_plotting, "cobot_lfd/learning/model.py", "def f():\n    import matplotlib"),
        (tools_or_tests_imported, "cobot_lfd/app/cli.py", "from tools import benchmark"),
        (hidden_import, "cobot_lfd/frame.py", "from importlib import import_module"),
        (hidden_import, "cobot_lfd/frame.py", "import importlib"),
    ],
)
def test_a_violation_is_caught(rule: Callable[[Import], bool], file: str, source: str) -> None:
    assert [found for found in read_imports(file, source) if rule(found)]


@pytest.mark.parametrize(
    ("rule", "file", "source"),
    [
        (core_sees_outward, "cobot_lfd/app/cli.py", "import robots, scenes, perception"),
        (core_sees_outward, "cobot_lfd/frame.py", "from cobot_lfd.arrays import Array"),
        (core_sees_outward, "cobot_lfd/frame.py", "import robotsuite"),
        (middle_sees_sideways_or_up, "scenes/world.py", "from scenes.view import Light"),
        (simulator_outside_its_rooms, "robots/arm.py", "import pybullet"),
        (opencv_outside_its_rooms, "cobot_lfd/app/pictures/video.py", "import cv2"),
        (ruckig_outside_timing, "cobot_lfd/motion/timing_ruckig.py", "import ruckig"),
        (viser_outside_studio, "cobot_lfd/app/studio/page.py", "import viser"),
        (plotting_at_start, "cobot_lfd/app/pictures/plot.py", "def f():\n    import matplotlib"),
        (plotting_at_start, "cobot_lfd/app/pictures/plot.py", "if TYPE_CHECKING:\n    import matplotlib"),
    ],
)
def test_what_is_allowed_is_not_caught(rule: Callable[[Import], bool], file: str, source: str) -> None:
    assert not [found for found in read_imports(file, source) if rule(found)]
