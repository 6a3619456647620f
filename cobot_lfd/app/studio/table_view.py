"""Table, objects and arm as nodes of the page's scene."""

from typing import Any

import numpy as np
import viser

from cobot_lfd.app.studio.looks import Look, link_poses, looks_of
from cobot_lfd.app.studio.meshes import Colour, patches_of
from cobot_lfd.arrays import Array
from scenes import World


class BodyView:
    """A body of the simulation on the page.

    Attributes:
        nodes: Number of a link to the node that moves with it.
        shapes: Number of a link to the nodes of its visible shapes, which can be dragged.
    """

    def __init__(self, server: viser.ViserServer, client: Any, body: int, name: str) -> None:
        looks = looks_of(client, body)
        self.body = body
        self.nodes = {
            link: server.scene.add_frame(f"{name}/{link + 1}", show_axes=False)
            for link in sorted({look.link for look in looks})
        }
        self.shapes: dict[int, list[Any]] = {link: [] for link in self.nodes}
        for i, look in enumerate(looks):
            self.shapes[look.link] += _add_shape(server, look, f"{name}/{look.link + 1}/{i}")
        self._shown: dict[int, Array] = {}
        self.move(client)

    def move(self, client: Any) -> None:
        """Show the body where it is now; what has not moved is not sent."""
        poses = link_poses(client, self.body)
        for link, node in self.nodes.items():
            pose = poses[link]
            if link in self._shown and np.abs(self._shown[link] - pose).max() < 1e-5:
                continue
            self._shown[link] = pose
            node.position = pose[:3]
            node.wxyz = pose[[6, 3, 4, 5]]

    def remove(self) -> None:
        """Take it off the page."""
        for node in self.nodes.values():
            node.remove()


class TableView:
    """All bodies of a scene on the page; the robot's meshes are sent once."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._robot: BodyView | None = None
        self._objects: list[BodyView] = []

    @property
    def robot(self) -> BodyView | None:
        """The robot; None before the first scene."""
        return self._robot

    def show(self, world: World, robot_body: int) -> None:
        """Show a scene instead of the one before."""
        client = world.client
        if self._robot is None:
            self._robot = BodyView(self._server, client, robot_body, "/robot")
        self._robot.body = robot_body
        for view in self._objects:
            view.remove()
        bodies = [client.getBodyUniqueId(i) for i in range(client.getNumBodies())]
        self._objects = [
            BodyView(self._server, client, body, f"/objects/{body}") for body in bodies if body != robot_body
        ]
        self.move(client)

    def move(self, client: Any) -> None:
        """Show all bodies where they are now."""
        for view in self._objects:
            view.move(client)
        if self._robot is not None:
            self._robot.move(client)


def _add_shape(server: viser.ViserServer, look: Look, name: str) -> list[Any]:
    """Nodes for a shape, fixed to its link's node."""
    x, y, z, w = look.link_from_shape.quaternion
    place: dict[str, Any] = {"wxyz": (w, x, y, z), "position": tuple(look.link_from_shape.position)}
    scene, colour = server.scene, _eight_bit(look.colour[:3])
    match look.kind:
        case "box":
            size = (look.size[0], look.size[1], look.size[2])
            return [scene.add_box(name, color=colour, dimensions=size, **place)]
        case "sphere":
            return [scene.add_icosphere(name, radius=look.size[0], color=colour, **place)]
        case "cylinder":
            height, radius = look.size
            return [scene.add_cylinder(name, radius=radius, height=height, color=colour, **place)]
        case "mesh":
            scale, patches = np.array(look.size), patches_of(look.file, look.colour[:3])
            return [
                scene.add_mesh_simple(
                    f"{name}/{i}",
                    vertices=scale * patch.vertices,
                    faces=patch.faces,
                    color=_eight_bit(patch.colour),
                    **place,
                )
                for i, patch in enumerate(patches)
            ]


def _eight_bit(colour: Colour) -> tuple[int, int, int]:
    red, green, blue = (round(255 * share) for share in colour)
    return red, green, blue
