"""A scene in the simulator, built from its description and a seed; the same two give the same world."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType, TracebackType
from typing import Self

import numpy as np
import pybullet
from pybullet_utils.bullet_client import BulletClient

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from cobot_lfd.pose import Pose
from cobot_lfd.quiet import quiet_output
from scenes.bodies import add_object, add_table, object_pose, place_object
from scenes.description import SceneDescription
from scenes.distractors import add_distractors
from scenes.placement import draw_placements
from scenes.printed import printed_faces
from scenes.prints import Print
from scenes.renderer import Renderer, load_renderer
from scenes.rendering import Picture, take_picture
from scenes.view import CameraDescription, Light
from scenes.watch import Watch

_SENSOR_STREAM, _DISTRACTOR_STREAM = 1, 3  # keep their chance apart from that of the layout


def connect(*, window: bool = False) -> BulletClient:
    """A simulation, with a window on the display or without one, in which worlds can be built."""
    with quiet_output():
        return BulletClient(pybullet.GUI if window else pybullet.DIRECT)


class World:
    """A simulated table with objects. Use it in a ``with`` statement; it ends with it.

    Attributes:
        description: The scene it was built from.
        client: The physics client; a robot adds itself to it.
        bodies: Name of an object to its body's number in the client.
        table: The table's body number in the client.
        renderer: What draws its pictures.
        distractors: Body numbers of what stands about without being part of the scene.
        watch: What has been noticed since the world was built. Only for the success check.
    """

    def __init__(
        self,
        description: SceneDescription,
        seed: int,
        *,
        renderer: Renderer = "tiny",
        window: bool = False,
        client: BulletClient | None = None,
    ) -> None:
        """Build the world.

        Args:
            description: The scene.
            seed: Decides where the objects stand.
            renderer: What draws the pictures: "tiny" needs nothing, "egl" is faster and draws other colours.
            window: Whether the simulator opens a window on the display; there can be one in a process, and
                every call then may wait for its picture.
            client: A simulation for one world after the other: it is emptied first, and goes on afterwards.
                The world is the same to the last bit. By default it has one of its own, which ends with it.
        """
        self.description = description
        with quiet_output():
            self.client = connect(window=window) if client is None else client
            self._plugin = load_renderer(self.client, renderer)
        self.renderer: Renderer = renderer
        self._is_lent = client is not None
        self._step = self.client.stepSimulation  # looked up once: it is called thousands of times
        self._n_steps = 0
        self._sensor_noise = np.random.default_rng([seed, _SENSOR_STREAM])
        _set_up_physics(self.client, description)
        self.table = add_table(self.client, description.table)
        placements = draw_placements(description, np.random.default_rng(seed))
        self.bodies: Mapping[str, int] = MappingProxyType(
            {name: add_object(self.client, description.objects[name], at) for name, at in placements.items()}
        )
        self._printed_faces = printed_faces(description)
        self.distractors = add_distractors(
            self.client, description, placements, np.random.default_rng([seed, _DISTRACTOR_STREAM])
        )
        self.watch = Watch(self.client, description, self.bodies)

    def __enter__(self) -> Self:
        """The world itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the simulation."""
        self.close()

    def close(self) -> None:
        """End the simulation, unless it was lent; the world cannot be used afterwards."""
        with quiet_output():
            if self._plugin is not None:
                self.client.unloadPlugin(self._plugin)
            if not self._is_lent:
                self.client.disconnect()

    @property
    def time(self) -> float:
        """Simulated time since the world was built [s]."""
        return self._n_steps * self.description.physics.time_step

    def step(self) -> None:
        """Let one time step pass."""
        self._step()
        self._n_steps += 1
        self.watch.look()

    def take_picture(
        self,
        *,
        covered: bool = False,
        camera: CameraDescription | None = None,
        light: Light | None = None,
        prints: Sequence[Print] = (),
    ) -> Picture:
        """What a camera sees now.

        Args:
            covered: Whether something covers the lens; the picture is then black.
            camera: The camera; the scene's own by default.
            light: The light; the scene's own by default.
            prints: Flat prints that are in the scene, besides those on its objects.

        Returns:
            Red, green, blue, shape (height, width, 3).
        """
        camera, light = camera or self.description.camera, light or self.description.light
        objects = self.description.objects
        on_objects = [
            face.at(object_pose(self.client, self.bodies[face.name], objects[face.name]))
            for face in self._printed_faces
        ]
        prints = [*on_objects, *prints]
        picture = take_picture(self.client, camera, light, self.renderer, self._sensor_noise, prints)
        return np.zeros_like(picture) if covered else picture

    def place(self, name: str, frame: Frame) -> None:
        """Put an object somewhere else on the table, at rest, before a task begins."""
        place_object(self.client, self.bodies[name], self.description.objects[name], frame)

    def true_poses(self) -> Mapping[str, Pose]:
        """Where the objects really are. Only for the success check, the scripted hand and tests."""
        return MappingProxyType({name: self.true_pose(name) for name in self.bodies})

    def true_pose(self, name: str) -> Pose:
        """Where an object really is. Only for the success check, the scripted hand and tests."""
        return object_pose(self.client, self.bodies[name], self.description.objects[name])

    def true_frames(self) -> Mapping[str, Frame]:
        """The planar part of the true poses. Only for the success check, the scripted hand and tests."""
        return MappingProxyType({name: _planar(pose) for name, pose in self.true_poses().items()})

    def true_centre(self, name: str) -> Pose:
        """Where an object's centre of mass really is. Only for the success check and tests."""
        return Pose.from_quaternion(*self.client.getBasePositionAndOrientation(self.bodies[name]))

    def true_velocity(self, name: str) -> tuple[Array, Array]:
        """Velocity [m/s] and turn rate [rad/s] of an object, shape (3,) each. Only for the success check."""
        velocity, turn_rate = self.client.getBaseVelocity(self.bodies[name])
        return np.array(velocity), np.array(turn_rate)

    def touching(self, name: str, body: int) -> bool:
        """Whether an object touches a body at this moment. Only for the success check and tests."""
        return len(self.client.getContactPoints(bodyA=self.bodies[name], bodyB=body)) > 0


def _planar(pose: Pose) -> Frame:
    return Frame(pose.position[:2], float(np.arctan2(pose.rotation[1, 0], pose.rotation[0, 0])))


def _set_up_physics(client: BulletClient, description: SceneDescription) -> None:
    client.resetSimulation()
    client.setGravity(0.0, 0.0, -description.physics.gravity)
    client.setPhysicsEngineParameter(
        fixedTimeStep=description.physics.time_step, deterministicOverlappingPairs=1
    )
