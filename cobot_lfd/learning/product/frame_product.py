"""The paper's generator: each frame's Gaussians and rings in the new scene, then their product."""

from dataclasses import dataclass

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.learning.data import Scenes
from cobot_lfd.learning.mixtures.encoding import Encoding
from cobot_lfd.learning.product import symmetric
from cobot_lfd.learning.product.approach import ApproachAngles
from cobot_lfd.learning.product.gather import Visits, gather
from cobot_lfd.learning.product.tracking import track


@dataclass(frozen=True, slots=True, eq=False)
class FrameProduct:
    """Regression per frame, then the product (paper, sections 3.3 and 4.5).

    Attributes:
        encoding: What is known of the path seen from each frame.
        oriented: Which frames are oriented; the others are rings.
        visits: Rings look along this sequence; None: towards the nearest frame at each time (paper, Table 1).
        approach: Learnt turns of the rings' directions; None: rings look straight along their line of sight.
        jerk_weight: Penalty on jerk in the path that follows the product's Gaussians; 0: their means.
    """

    encoding: Encoding
    oriented: tuple[bool, ...]
    visits: Visits | None
    approach: ApproachAngles | None
    jerk_weight: float

    def generate(self, scenes: Scenes, n_steps: int) -> tuple[Array, Array]:
        """Means [m], shape (S, T, d), and covariances [m²], shape (S, T, d, d)."""
        times = np.linspace(0.0, 1.0, n_steps)
        profile = self.encoding.profile(times)
        information = gather(profile, scenes, self.oriented, times, self.visits, self.approach)
        mean, covariance = information.moments()
        if self.jerk_weight > 0:
            mean = track(information, self.jerk_weight)
        return np.swapaxes(mean, 1, 2), symmetric.unpack(covariance, mean.shape[1])
