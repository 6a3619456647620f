"""Objects as bodies of the simulator, built from boxes and balls."""

from functools import lru_cache

import numpy as np
import pybullet
from pybullet_utils.bullet_client import BulletClient

from cobot_lfd.arrays import Array
from cobot_lfd.frame import Frame
from cobot_lfd.pose import Pose
from scenes.boxes import Block, blocks_of
from scenes.colours import Colour
from scenes.shapes import Ball, ObjectDescription, Table


def add_table(client: BulletClient, table: Table) -> int:
    """Add the table, its top at z = 0; returns its body number."""
    half_size = np.array([*table.size, table.thickness]) / 2
    block = Block(np.array([*table.centre, -half_size[2]]), half_size)
    body = _add_blocks(client, (block,), Pose.identity(), mass=0.0, colour=table.colour)
    client.changeDynamics(body, -1, lateralFriction=table.friction)
    return body


def add_object(client: BulletClient, item: ObjectDescription, frame: Frame) -> int:
    """Add an object that stands on the table at a frame; returns its body number."""
    if isinstance(item, Ball):
        body = _add_ball(client, item, _standing(frame))
    else:
        body = _add_blocks(client, blocks_of(item), _standing(frame), mass=item.mass, colour=item.colour)
    client.changeDynamics(
        body,
        -1,
        lateralFriction=item.friction,
        spinningFriction=item.spinning_friction,
        rollingFriction=item.rolling_friction,
        restitution=0.0,
    )
    return body


def place_object(client: BulletClient, body: int, item: ObjectDescription, frame: Frame) -> None:
    """Put an object on the table at a frame, at rest."""
    pose = _standing(frame)
    centre = pose.apply(_centre_of_mass(blocks_of(item)))
    client.resetBasePositionAndOrientation(body, centre.tolist(), pose.quaternion.tolist())
    client.resetBaseVelocity(body, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])


def object_pose(client: BulletClient, body: int, item: ObjectDescription) -> Pose:
    """Where an object's frame really is, the middle of its foot."""
    world_from_centre = Pose.from_quaternion(*client.getBasePositionAndOrientation(body))
    return world_from_centre @ _centre_from_foot(item)


@lru_cache(maxsize=256)
def _centre_from_foot(item: ObjectDescription) -> Pose:
    """Where an object's frame is in that of its centre of mass."""
    return Pose(-_centre_of_mass(blocks_of(item)), np.eye(3))


def _standing(frame: Frame) -> Pose:
    """The pose of an object that stands on the table."""
    return Pose.from_rpy([*frame.position, 0.0], [0.0, 0.0, frame.angle])


def _add_blocks(
    client: BulletClient, blocks: tuple[Block, ...], pose: Pose, *, mass: float, colour: Colour
) -> int:
    """Add boxes that are fixed to one another; the simulator wants their centre of mass as origin."""
    centre = _centre_of_mass(blocks)
    shapes = {
        "shapeTypes": [pybullet.GEOM_BOX] * len(blocks),
        "halfExtents": [block.half_size.tolist() for block in blocks],
    }
    places = [(block.centre - centre).tolist() for block in blocks]
    body = client.createMultiBody(
        baseMass=mass,
        baseCollisionShapeIndex=client.createCollisionShapeArray(**shapes, collisionFramePositions=places),
        baseVisualShapeIndex=client.createVisualShapeArray(**shapes, visualFramePositions=places),
        basePosition=pose.apply(centre).tolist(),
        baseOrientation=pose.quaternion.tolist(),
    )
    client.changeVisualShape(body, -1, rgbaColor=[*colour, 1.0], specularColor=[0.0, 0.0, 0.0])
    for i, block in enumerate(blocks):
        if block.colour is not None:
            client.changeVisualShape(body, -1, shapeIndex=i, rgbaColor=[*block.colour, 1.0])
    return int(body)


def _add_ball(client: BulletClient, ball: Ball, pose: Pose) -> int:
    shape = {"shapeType": pybullet.GEOM_SPHERE, "radius": ball.diameter / 2}
    body = client.createMultiBody(
        baseMass=ball.mass,
        baseCollisionShapeIndex=client.createCollisionShape(**shape),
        baseVisualShapeIndex=client.createVisualShape(**shape),
        basePosition=pose.apply([0.0, 0.0, ball.diameter / 2]).tolist(),
        baseOrientation=pose.quaternion.tolist(),
    )
    client.changeVisualShape(body, -1, rgbaColor=[*ball.colour, 1.0], specularColor=[0.0, 0.0, 0.0])
    return int(body)


def _centre_of_mass(blocks: tuple[Block, ...]) -> Array:
    volumes = np.array([np.prod(block.half_size) for block in blocks])
    return np.asarray(volumes @ np.array([block.centre for block in blocks]) / volumes.sum())
