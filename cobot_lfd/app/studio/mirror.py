"""The simulator's window in a process of its own: it shows what it is told, and tells what mouse and keys do.

A simulation with a window waits for the window's picture now and then, in any of its calls: led by a hand at
500 Hz it reached 0.03 to 0.16 times real time where the same physics without a window reached 5.6 times.
So the physics runs elsewhere, and the window has a copy of the scene in which no time passes. What the mouse
points at is picked there.
"""

import os
import signal
from dataclasses import dataclass
from enum import Enum
from multiprocessing.connection import Connection
from typing import Any, Literal

import numpy as np

from cobot_lfd.arrays import Array
from robots import Arm, load_robot
from scenes import World, load_scene

_FAR = 10.0  # [m] along the ray through the pointer
_LOOK_EVERY = 1 / 60  # [s] between two looks at mouse and keys
_MOVED, _BUTTON, _LEFT, _PRESSED, _RELEASED = 1, 2, 0, 3, 4  # as the window numbers its mouse's events
_ORANGE, _BLACK = (0.94, 0.47, 0.08), (0.1, 0.1, 0.1)
_DISTANCE, _YAW, _PITCH = 0.9, 60.0, -35.0  # of the camera at first: [m], [degrees]


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """What the window is to show.

    Attributes:
        bodies: Place and quaternion x, y, z, w of every body's base, by number, shape (B, 7).
        joints: Positions of the robot's movable joints, shape (n,).
        force: From the tool to where the hand wants it [m], shape (2, 3); None where nobody pulls.
        text: What is going on.
    """

    bodies: Array
    joints: Array
    force: Array | None
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Drag:
    """What the mouse did to the arm.

    Attributes:
        phase: Whether it took hold, moved on, or let go.
        camera: The window's camera [m], shape (3,).
        pointer: The pointer on the plane through the grabbed point that faces the camera [m], shape (3,).
    """

    phase: Literal["start", "move", "end"]
    camera: Array
    pointer: Array


class Signal(Enum):
    """What else the window tells."""

    OPENED = "it is there"
    SHOWN = "it shows what it was told, and has time for more"


def movable_joints(client: Any, body: int) -> list[int]:
    """Numbers of the joints of a body that can move."""
    joints = range(client.getNumJoints(body))
    return [joint for joint in joints if client.getJointInfo(body, joint)[2] != client.JOINT_FIXED]


def sight_of(client: Any, robot: int, force: Array | None, text: str) -> Sight:
    """What a window shows of a simulation."""
    bodies = [client.getBodyUniqueId(i) for i in range(client.getNumBodies())]
    poses = [np.concatenate(client.getBasePositionAndOrientation(body)) for body in bodies]
    joints = [state[0] for state in client.getJointStates(robot, movable_joints(client, robot))]
    return Sight(np.array(poses), np.array(joints), force, text)


def show_window(connection: Connection, scene_name: str, robot_name: str) -> None:
    """Open the window, and work until the other end of the connection or the window is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the other process decides when this ends
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)  # the simulator talks a lot about its graphics
        os.dup2(nowhere.fileno(), 2)
    scene = load_scene(scene_name)
    with World(scene, 0, window=True) as world:
        arm = Arm(world.client, load_robot(robot_name, scene.task.tool))
        mirror = Mirror(world.client, arm.body.id, connection)
        connection.send(Signal.OPENED)
        try:
            while True:
                mirror.look()
        except (EOFError, OSError, world.client.error):
            pass  # one of the two was closed


class Mirror:
    """The window's copy of the scene, and the mouse over it."""

    def __init__(self, client: Any, robot: int, connection: Connection) -> None:
        self._client, self._robot, self._connection = client, robot, connection
        self._joints = movable_joints(client, robot)
        self._bodies: Array | None = None
        self._grabbed: Array | None = None
        self._line, self._label, self._text = -1, -1, ""
        _arrange(client)

    def look(self) -> None:
        """Show what there is to show, and tell what mouse and keys did."""
        if self._connection.poll(_LOOK_EVERY):
            self._show(self._connection.recv())
            self._connection.send(Signal.SHOWN)
        held = self._client.getKeyboardEvents()
        for key, state in held.items():  # of a quick tap nothing is told but its end
            if state & self._client.KEY_WAS_RELEASED and 0 < key < 128:
                self._connection.send(chr(key).upper())
        for kind, x, y, button, state in self._client.getMouseEvents():
            if kind == _BUTTON and button == _LEFT and state == _PRESSED:
                if self._client.B3G_CONTROL not in held:  # which turns the camera
                    self._take_hold(x, y)
            elif kind == _BUTTON and button == _LEFT and state == _RELEASED:
                self._tell("end", x, y)
                self._grabbed = None
            elif kind == _MOVED:
                self._tell("move", x, y)

    def _show(self, sight: Sight) -> None:
        client = self._client
        client.resetJointStatesMultiDof(self._robot, self._joints, [[position] for position in sight.joints])
        before = np.full_like(sight.bodies, np.inf) if self._bodies is None else self._bodies
        for body in np.flatnonzero(np.abs(sight.bodies - before).max(axis=1) > 1e-5):
            pose = sight.bodies[body].tolist()
            client.resetBasePositionAndOrientation(int(body), pose[:3], pose[3:])
        self._bodies = sight.bodies
        self._show_force(sight.force)
        if sight.text != self._text:
            self._text = sight.text
            place, old = [0.9, -0.9, 0.0], {"replaceItemUniqueId": self._label} if self._label >= 0 else {}
            self._label = client.addUserDebugText(sight.text, place, _BLACK, 1.5, **old)

    def _show_force(self, force: Array | None) -> None:
        if force is not None:
            old = {"replaceItemUniqueId": self._line} if self._line >= 0 else {}
            self._line = self._client.addUserDebugLine(*force.tolist(), _ORANGE, 4.0, **old)
        elif self._line >= 0:
            self._client.removeUserDebugItem(self._line)
            self._line = -1

    def _take_hold(self, x: float, y: float) -> None:
        """Begin a drag, where the pointer is on the arm."""
        camera, ray, _ = self._ray(x, y)
        self._client.performCollisionDetection()  # bodies were moved without physics
        body, _, _, place, _ = self._client.rayTest(camera.tolist(), (camera + _FAR * ray).tolist())[0]
        if body == self._robot:
            self._grabbed = np.array(place)
            self._tell("start", x, y)

    def _tell(self, phase: Literal["start", "move", "end"], x: float, y: float) -> None:
        """Tell where the pointer is, during a drag."""
        if self._grabbed is not None:
            camera, ray, forward = self._ray(x, y)
            depth = (self._grabbed - camera) @ forward / (ray @ forward)
            self._connection.send(Drag(phase, camera, camera + depth * ray))

    def _ray(self, x: float, y: float) -> tuple[Array, Array, Array]:
        """The camera's place, the direction through a pixel, and the one in which the camera looks."""
        view = self._client.getDebugVisualizerCamera()
        forward, right, up = (np.array(view[i]) / np.linalg.norm(view[i]) for i in (5, 6, 7))
        camera = np.array(view[11]) - view[10] * forward
        across, upward = 1.0 / view[3][0], 1.0 / view[3][5]  # of the projection: half the width and height
        u, v = 2.0 * (x + 0.5) / view[0] - 1.0, 1.0 - 2.0 * (y + 0.5) / view[1]
        ray = forward + u * across * right + v * upward * up
        return camera, ray / np.linalg.norm(ray), forward


def _arrange(client: Any) -> None:
    """Show the picture alone, seen from in front of the table; mouse and keys are left to us."""
    for off in (
        client.COV_ENABLE_GUI,
        client.COV_ENABLE_MOUSE_PICKING,
        client.COV_ENABLE_KEYBOARD_SHORTCUTS,
        client.COV_ENABLE_RGB_BUFFER_PREVIEW,
        client.COV_ENABLE_DEPTH_BUFFER_PREVIEW,
        client.COV_ENABLE_SEGMENTATION_MARK_PREVIEW,
        client.COV_ENABLE_SHADOWS,
    ):
        client.configureDebugVisualizer(off, 0)
    client.resetDebugVisualizerCamera(_DISTANCE, _YAW, _PITCH, [0.42, 0.0, 0.24])
