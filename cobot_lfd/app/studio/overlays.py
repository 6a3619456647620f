"""What is drawn over the scene: the hand's force, joints near their limits, paths, frames, covariance."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import viser

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.pictures.plot import ellipse_axes
from cobot_lfd.app.studio.looks import link_poses
from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from cobot_lfd.learning.path import GeneratedPath
from robots import RobotDescription

_NEAR_LIMIT = 0.15  # [rad] from a limit at which a joint begins to glow
_ON_TABLE = 0.004  # [m] above the table, where planar paths are drawn
_PLUMB_LENGTH = 0.5  # [m]; what is below the table cannot be seen
_N_ELLIPSES = 16
_PLUMB, _FORCE = (120, 120, 120), (240, 120, 20)
_PATH, _GENERATED, _COVARIANCE = (90, 90, 90), (10, 10, 10), (86, 180, 233)


class ForceLine:
    """The line from the tool to where the hand wants it, drawn while the hand pulls.

    It is a rod of length 1 that is moved, turned and stretched: the page draws a line with new ends anew.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._rod = server.scene.add_cylinder("/hand/force", radius=0.004, height=1.0, color=_FORCE)
        self._end = server.scene.add_icosphere("/hand/pointer", radius=0.012, subdivisions=2, color=_FORCE)
        self._rod.visible = self._end.visible = False

    def show(self, tool: Array, pointer: Array | None) -> None:
        """Draw it, or hide it where nobody pulls."""
        if pointer is not None:
            way = pointer - tool
            self._rod.position = tool + 0.5 * way
            self._rod.wxyz = _from_vertical(way)
            self._rod.scale = (1.0, 1.0, max(float(np.linalg.norm(way)), 1e-3))
            self._end.position = pointer
        pulls = pointer is not None
        if self._rod.visible != pulls:
            self._rod.visible = self._end.visible = pulls


class Plumb:
    """A thin line from the tool down through the table, which shows where the tool would come down."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._line = server.scene.add_line_segments(
            "/hand/plumb",
            np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, -_PLUMB_LENGTH]]], dtype=np.float32),
            colors=_PLUMB,
            thickness=1.5,
            thickness_units="screen",
        )
        self._foot = server.scene.add_cylinder("/hand/foot", radius=0.008, height=0.001, color=_PLUMB)

    def show(self, tool: Array) -> None:
        """Draw it for a place of the tool [m], shape (3,)."""
        self._line.position = tool
        self._foot.position = np.array([tool[0], tool[1], _ON_TABLE])


class Glow:
    """A red sphere at every joint that is near its limit, the redder the nearer."""

    def __init__(self, server: viser.ViserServer, robot: RobotDescription) -> None:
        limits = robot.joint_limits
        self._lower, self._upper = limits.position_lower, limits.position_upper
        self._spheres = [
            server.scene.add_icosphere(f"/glow/{i}", radius=0.09, color=(255, 40, 20), opacity=0.5)
            for i in range(len(self._lower))
        ]
        for sphere in self._spheres:
            sphere.visible = False

    def show(self, client: Any, body: int, joints: list[int]) -> list[int]:
        """Draw it; returns which joints are near their limits, counted from 1."""
        positions = np.array([state[0] for state in client.getJointStates(body, joints)])
        room = np.minimum(positions - self._lower, self._upper - positions)
        near = np.flatnonzero(room < _NEAR_LIMIT)
        places = link_poses(client, body) if len(near) else {}
        for i, sphere in enumerate(self._spheres):
            if i in near:
                sphere.position = places[joints[i]][:3]
                sphere.opacity = float(np.clip(0.7 - 0.6 * room[i] / _NEAR_LIMIT, 0.1, 0.7))
            if sphere.visible != (i in near):
                sphere.visible = bool(i in near)
        return [int(i) + 1 for i in near]


class Paths:
    """Planar paths on the table: what was shown, and what was learnt from it."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._shown: list[Any] = []
        self._generated: list[Any] = []

    def show_demonstrations(
        self, episodes: Iterable[RecordedEpisode], seen_from: str | None, here: Mapping[str, Frame]
    ) -> None:
        """Draw the carries: where they were, or as one frame saw them, laid out from where it is now."""
        _clear(self._shown)
        for i, episode in enumerate(episodes):
            path = episode.tool_positions[episode.carrying, :2]
            frames = {seen.name: seen.frame for seen in episode.detections}
            if seen_from is not None:
                if seen_from not in frames or seen_from not in here:
                    continue
                path = here[seen_from].apply(frames[seen_from].localise(path))
            if len(path) > 1:
                self._shown.append(self._line(f"/paths/{i}", path[::5], _PATH, 3.0))

    def show_generated(self, path: GeneratedPath | None) -> None:
        """Draw a path with ellipses of two standard deviations; None to draw none."""
        _clear(self._generated)
        if path is None:
            return
        for i in np.unique(np.linspace(0, len(path.mean) - 1, _N_ELLIPSES).astype(int)):
            outline = _ellipse(path.mean[i], path.covariance[i])
            self._generated.append(self._line(f"/learnt/{i}", outline, _COVARIANCE, 2.0))
        self._generated.append(self._line("/learnt/mean", path.mean[::2], _GENERATED, 5.0))

    def _line(self, name: str, points: Array, colour: tuple[int, int, int], width: float) -> Any:
        lifted = np.column_stack([points, np.full(len(points), _ON_TABLE)])
        segments = np.stack([lifted[:-1], lifted[1:]], axis=1).astype(np.float32)
        return self._server.scene.add_line_segments(
            name, segments, colors=colour, thickness=width, thickness_units="screen"
        )


def _from_vertical(way: Array) -> Array:
    """The shortest turn from the z axis into a direction, as a quaternion w, x, y, z."""
    x, y, z = way / max(float(np.linalg.norm(way)), 1e-9)
    turn = np.array([1.0 + z, -y, x, 0.0])
    length = float(np.linalg.norm(turn))
    return turn / length if length > 1e-6 else np.array([0.0, 1.0, 0.0, 0.0])


def _ellipse(centre: Array, covariance: Array) -> Array:
    """The outline at two standard deviations [m], shape (33, 2)."""
    long, short, degrees = ellipse_axes(covariance)
    turn = np.linspace(0.0, 2 * np.pi, 33)
    circle = np.column_stack([0.5 * long * np.cos(turn), 0.5 * short * np.sin(turn)])
    return Frame(centre, float(np.deg2rad(degrees))).apply(circle)


def _clear(nodes: list[Any]) -> None:
    for node in nodes:
        node.remove()
    nodes.clear()
