"""Whether an arm in a posture would hit itself or something around it."""

from collections.abc import Iterable, Iterator, Sequence
from types import TracebackType
from typing import Any

import numpy as np
import pybullet
from scipy.spatial.transform import Rotation

from cobot_lfd.arrays import Array
from cobot_lfd.obstacle import Obstacle
from cobot_lfd.pose import Pose
from robots.body import RobotBody
from robots.chain import Chain

_Hit = tuple[int, int, int]
"""What touches what: number of the other body, link, link of the other body."""

_DEPTH = 0.001  # [m]; less than this, bodies only touch: a part on a table, a cup on a part


class CollisionCheck:
    """Looks for collisions of postures with obstacles; use it in a ``with`` statement.

    What touches already in the postures that the arm is known to take (neighbouring links, the base on the
    table) does not count.
    """

    def __init__(
        self,
        client: Any,
        body: RobotBody,
        chain: Chain,
        obstacles: Sequence[Obstacle],
        postures: Iterable[Array],
    ) -> None:
        self._client = client
        self._body = body
        self._chain = chain
        self._names = {_add(client, obstacle, mass=0.0): obstacle.name for obstacle in obstacles}
        self._part: int | None = None
        self._tool_from_part = Pose.identity()
        self._allowed = frozenset[_Hit]().union(*self._touching(np.array([*postures])))

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
        for touching in self._touching(path):
            hits = touching - self._allowed
            if hits:
                return self._told(min(hits))
        return None

    def _touching(self, path: Array) -> Iterator[frozenset[_Hit]]:
        """What touches what, posture by posture."""
        places = [None] * len(path) if self._part is None else self._part_places(path)
        for posture, place in zip(path, places, strict=True):
            self._body.place(posture)
            bodies = [self._body.id]
            if self._part is not None and place is not None:
                self._client.resetBasePositionAndOrientation(self._part, *place)
                bodies.append(self._part)
            self._client.performCollisionDetection()
            contacts = [contact for body in bodies for contact in self._client.getContactPoints(bodyA=body)]
            yield frozenset((int(c[2]), int(c[3]), int(c[4])) for c in contacts if c[8] < -_DEPTH)

    def _part_places(self, path: Array) -> Sequence[tuple[list[float], list[float]]]:
        """Position and quaternion of the part that is held, in each posture."""
        reach = self._chain.reach(path)
        positions = reach.positions + reach.rotations @ self._tool_from_part.position
        turns = Rotation.from_matrix(reach.rotations @ self._tool_from_part.rotation, assume_valid=True)
        return list(zip(positions.tolist(), turns.as_quat().tolist(), strict=True))

    def _told(self, hit: _Hit) -> str:
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
