"""Whether an arm in a posture would hit itself or something around it."""

from collections.abc import Iterable, Sequence
from types import TracebackType
from typing import Any

import numpy as np
import pybullet

from cobot_lfd.arrays import Array
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from robots.body import RobotBody

_DEPTH = 0.001  # [m]; less than this, bodies only touch: a part on a table, a cup on a part


class CollisionCheck:
    """Looks for collisions of postures with obstacles; use it in a ``with`` statement.

    What touches already in the postures that the arm is known to take (neighbouring links, the base on the
    table) does not count.
    """

    def __init__(
        self, client: Any, body: RobotBody, obstacles: Sequence[Obstacle], postures: Iterable[Array]
    ) -> None:
        self._client = client
        self._body = body
        self._names = {_add(client, obstacle, mass=0.0): obstacle.name for obstacle in obstacles}
        self._part: int | None = None
        self._tool_from_part = Pose.identity()
        self._allowed: frozenset[tuple[int, int, int]] = frozenset()
        self._allowed = frozenset().union(*(self._touching(posture) for posture in postures))

    def __enter__(self) -> "CollisionCheck":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number in (*self._names, *((self._part,) if self._part is not None else ())):
            self._client.removeBody(number)

    def hold(self, part: Obstacle, tool_from_part: Pose) -> None:
        """From now on the tool holds a part, which must not hit anything either."""
        self._part = _add(self._client, part, mass=1.0)
        self._tool_from_part = tool_from_part
        for link in range(-1, self._client.getNumJoints(self._body.id)):
            self._client.setCollisionFilterPair(self._part, self._body.id, -1, link, 0)

    def release(self) -> None:
        """From now on the tool holds nothing."""
        if self._part is not None:
            self._client.removeBody(self._part)
            self._part = None

    def first_hit(self, path: Array) -> str | None:
        """What is hit first along a joint path [rad], shape (M, n), as a sentence; None if nothing is."""
        for posture in path:
            hits = self._touching(posture) - self._allowed
            if hits:
                return self._told(min(hits))
        return None

    def _touching(self, posture: Array) -> frozenset[tuple[int, int, int]]:
        """What touches what: number of the other body, link, link of the other body."""
        self._body.place(posture)
        if self._part is not None:
            world_from_centre = self._body.tool_pose() @ self._tool_from_part
            self._client.resetBasePositionAndOrientation(
                self._part, world_from_centre.position.tolist(), world_from_centre.quaternion.tolist()
            )
        self._client.performCollisionDetection()
        contacts = list(self._client.getContactPoints(bodyA=self._body.id))
        if self._part is not None:
            contacts += self._client.getContactPoints(bodyA=self._part)
        return frozenset((int(c[2]), int(c[3]), int(c[4])) for c in contacts if c[8] < -_DEPTH)

    def _told(self, hit: tuple[int, int, int]) -> str:
        other, link, other_link = hit
        if other == self._body.id:
            return f"the arm's link {link} would hit its link {other_link}"
        return f"the arm or its part would hit the {self._names.get(other, 'part')}"


def _add(client: Any, obstacle: Obstacle, *, mass: float) -> int:
    shapes = client.createCollisionShapeArray(
        shapeTypes=[pybullet.GEOM_BOX] * len(obstacle.centres),
        halfExtents=obstacle.half_sizes.tolist(),
        collisionFramePositions=obstacle.centres.tolist(),
    )
    return int(
        client.createMultiBody(
            baseMass=mass,
            baseCollisionShapeIndex=shapes,
            basePosition=obstacle.pose.position.tolist(),
            baseOrientation=obstacle.pose.quaternion.tolist(),
        )
    )


def thinned(path: Array, every: int) -> Array:
    """Every so many-th posture of a path, and the last."""
    return np.vstack([path[::every], path[-1:]])
