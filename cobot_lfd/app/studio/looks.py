"""What the bodies of a simulation look like and where they are, for a page that shows them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.pose import Pose


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """A visible shape that is fixed to a link of a body.

    Attributes:
        link: Number of the link; -1 is the base.
        kind: What it is.
        size: Extent along x, y, z of a box; radius of a sphere; height and radius of a cylinder; scale of
            a mesh along x, y, z [m].
        file: Of a mesh.
        link_from_shape: Where it is on its link.
        colour: Red, green, blue, opacity in 0..1.
    """

    link: int
    kind: Literal["box", "sphere", "cylinder", "mesh"]
    size: tuple[float, ...]
    file: Path
    link_from_shape: Pose
    colour: tuple[float, float, float, float]


def looks_of(client: Any, body: int) -> tuple[Look, ...]:
    """The visible shapes of a body; shapes of other kinds than these four are left out."""
    kinds: dict[int, Literal["box", "sphere", "cylinder", "mesh"]] = {
        client.GEOM_BOX: "box",
        client.GEOM_SPHERE: "sphere",
        client.GEOM_CYLINDER: "cylinder",
        client.GEOM_MESH: "mesh",
    }
    return tuple(
        Look(
            link=shape[1],
            kind=kinds[shape[2]],
            size=_size(kinds[shape[2]], shape[3]),
            file=Path(shape[4].decode()),
            link_from_shape=Pose.from_quaternion(shape[5], shape[6]),
            colour=shape[7],
        )
        for shape in client.getVisualShapeData(body)
        if shape[2] in kinds
    )


def link_poses(client: Any, body: int) -> dict[int, Array]:
    """Where the links of a body are: number to x, y, z [m] and quaternion x, y, z, w, shape (7,)."""
    inertial = client.getDynamicsInfo(body, -1)
    centre_from_base = client.invertTransform(inertial[3], inertial[4])
    world_from_centre = client.getBasePositionAndOrientation(body)
    poses = {-1: np.concatenate(client.multiplyTransforms(*world_from_centre, *centre_from_base))}
    n_links = client.getNumJoints(body)
    if n_links:
        states = client.getLinkStates(body, list(range(n_links)), computeForwardKinematics=True)
        poses |= {link: np.array([*state[4], *state[5]]) for link, state in enumerate(states)}
    return poses


def _size(kind: str, dimensions: tuple[float, ...]) -> tuple[float, ...]:
    if kind == "sphere":
        return (float(dimensions[0]),)
    if kind == "cylinder":
        return float(dimensions[0]), float(dimensions[1])
    return tuple(float(length) for length in dimensions)
