"""One URDF from an arm and the tool that is mounted on it."""

import math
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import pybullet_data

from cobot_lfd.errors import DescriptionError
from robots.parts import Mount, Part, PartBox

_MOUNT = "mount"
_SLIDE_EFFORT, _SLIDE_VELOCITY = "100", "1"  # The gripper's own description says what its motors do.


def find_urdf(name: str, package: str | None) -> Path:
    """The file of a URDF in pybullet_data, or in another installed package.

    Raises:
        DescriptionError: If it is not there; the message says what to install.
    """
    if package is None:
        return Path(pybullet_data.getDataPath()) / name
    try:
        found = [file for file in files(package) or () if file.as_posix().endswith(name)]
    except PackageNotFoundError:
        found = []
    if not found:
        raise DescriptionError(
            f"{name} comes with the package '{package}', which is not installed; "
            "install it with: pip install 'cobot-lfd[robots]'"
        )
    return Path(str(found[0].locate()))


def has_urdf(name: str, package: str | None) -> bool:
    """Whether a robot's URDF is installed."""
    try:
        return find_urdf(name, package).is_file()
    except DescriptionError:
        return False


def compose(urdf: Path, mount: Mount, parts: Mapping[str, Part]) -> str:
    """The text of a URDF: an arm up to its mounting face, and a tool's links beyond.

    Meshes are named by absolute paths, so that the text can be loaded from anywhere. The meshes against which
    collisions are computed are drawn as well where the finer ones take long to load.

    Args:
        urdf: The arm's URDF.
        mount: Where the tool is mounted.
        parts: Name of a link of the tool to the link.

    Raises:
        DescriptionError: If the arm has no such link.
    """
    robot = ElementTree.parse(urdf).getroot()
    if mount.link not in {link.get("name") for link in robot.findall("link")}:
        raise DescriptionError(f"{urdf} has no link named '{mount.link}', on which a tool could be mounted.")
    _cut_off(robot, mount.link)
    _draw_quickly(robot)
    for mesh in robot.iter("mesh"):
        mesh.set("filename", str(_mesh_file(mesh.get("filename", ""), urdf)))
    SubElement(robot, "link", name=_MOUNT)
    rpy = tuple(math.radians(angle) for angle in mount.rpy_deg)
    _join(robot, mount.link, _MOUNT, mount.position, rpy)
    for name, part in parts.items():
        _add_part(robot, name, part)
    return ElementTree.tostring(robot, encoding="unicode")


def _cut_off(robot: Element, link: str) -> None:
    """Remove all that hangs on a link."""
    for joint in robot.findall("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is None or child is None or parent.get("link") != link:
            continue
        robot.remove(joint)
        _cut_off(robot, str(child.get("link")))
        for found in robot.findall("link"):
            if found.get("name") == child.get("link"):
                robot.remove(found)


def _draw_quickly(robot: Element) -> None:
    """Draw the meshes for collisions where the meshes for the eye are large Collada files."""
    for link in robot.findall("link"):
        seen, solid = link.find("visual/geometry/mesh"), link.find("collision/geometry/mesh")
        if seen is not None and solid is not None and str(seen.get("filename")).endswith(".dae"):
            seen.set("filename", str(solid.get("filename")))


def _mesh_file(name: str, urdf: Path) -> Path:
    """The file of a mesh: relative to the URDF, or to a folder above it."""
    relative = name.removeprefix("package://")
    for folder in urdf.parents:
        if (folder / relative).is_file():
            return folder / relative
    raise DescriptionError(f"{urdf} names the mesh {name}, which is not there.")


def _add_part(robot: Element, name: str, part: Part) -> None:
    link = SubElement(robot, "link", name=name)
    if part.mass > 0.0:
        inertial = SubElement(link, "inertial")
        SubElement(inertial, "mass", value=str(part.mass))
        inertia = str(1e-3 * part.mass)
        SubElement(inertial, "inertia", ixx=inertia, iyy=inertia, izz=inertia, ixy="0", ixz="0", iyz="0")
    for box in part.boxes:
        visual = _add_box(link, "visual", box)
        material = SubElement(visual, "material", name=f"{name}_colour")
        SubElement(material, "color", rgba=_text((*part.colour, 1.0)))
        _add_box(link, "collision", box)
    joint = _join(robot, part.parent, name, part.position, (0.0, 0.0, 0.0))
    if part.slide is not None:
        joint.set("type", "prismatic")
        SubElement(joint, "axis", xyz=_text(part.slide.axis))
        SubElement(
            joint,
            "limit",
            lower="0",
            upper=str(part.slide.travel),
            effort=_SLIDE_EFFORT,
            velocity=_SLIDE_VELOCITY,
        )


def _add_box(link: Element, kind: str, box: PartBox) -> Element:
    element = SubElement(link, kind)
    middle = [0.5 * (low + high) for low, high in zip(box.low, box.high, strict=True)]
    SubElement(element, "origin", xyz=_text(middle), rpy="0 0 0")
    size = [high - low for low, high in zip(box.low, box.high, strict=True)]
    SubElement(SubElement(element, "geometry"), "box", size=_text(size))
    return element


def _join(
    robot: Element,
    parent: str,
    child: str,
    position: tuple[float, ...],
    rpy: tuple[float, ...],
) -> Element:
    joint = SubElement(robot, "joint", name=f"{child}_joint", type="fixed")
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    SubElement(joint, "origin", xyz=_text(position), rpy=_text(rpy))
    return joint


def _text(numbers: list[float] | tuple[float, ...]) -> str:
    return " ".join(f"{number:.12g}" for number in numbers)
