"""What is noticed while the task goes on, for the check of success at its end."""

from collections.abc import Mapping

import numpy as np
from pybullet_utils.bullet_client import BulletClient

from scenes.bodies import object_pose
from scenes.description import SceneDescription


class Watch:
    """Looks at the world after every step.

    Attributes:
        largest_force: Largest force so far on what the object is to lie in [N].
        passed: Whether the object has passed where it must pass; true where it need not pass anywhere.
    """

    def __init__(
        self, client: BulletClient, description: SceneDescription, bodies: Mapping[str, int]
    ) -> None:
        self.largest_force = 0.0
        self.passed = description.success.through is None
        self._client = client
        self._description = description
        self._bodies = bodies

    def look(self) -> None:
        """Notice what has happened in the last step."""
        if self._description.success.max_force is not None:
            self.largest_force = max(self.largest_force, self._force())
        self.passed = self.passed or self._passes()

    def _force(self) -> float:
        """Sum of the contact forces on what the object is to lie in [N]."""
        contacts = self._client.getContactPoints(bodyA=self._bodies[self._description.success.container])
        return float(sum(contact[9] for contact in contacts))

    def _passes(self) -> bool:
        criterion = self._description.success
        passage = criterion.through
        if passage is None:
            return True
        item = self._description.objects[passage.frame]
        world_from_passage = object_pose(self._client, self._bodies[passage.frame], item)
        centre, _ = self._client.getBasePositionAndOrientation(self._bodies[criterion.object])
        local = world_from_passage.inverse().apply(centre)
        return bool((np.array(passage.low) <= local).all() and (local <= np.array(passage.high)).all())
