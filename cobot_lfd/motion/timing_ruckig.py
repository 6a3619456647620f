"""Ruckig, for one degree of freedom: the fastest way between two states with bounded jerk.

Everything else sees time laws. ``intermediate_positions`` is never set: in the community edition it would
post the problem to a server.
"""

import numpy as np
import ruckig

from cobot_lfd.arrays import Array
from cobot_lfd.errors import MotionError
from cobot_lfd.motion.time_law import TimeLaw


def rest_to_rest(velocity: float, acceleration: float, jerk: float) -> TimeLaw:
    """The fastest time law from s = 0 to s = 1, at rest at both, within limits on s', s'' and s'''."""
    inputs = ruckig.InputParameter(1)
    inputs.current_position, inputs.target_position = [0.0], [1.0]
    inputs.max_velocity, inputs.max_acceleration, inputs.max_jerk = [velocity], [acceleration], [jerk]
    return _law(_calculated(inputs))


def _calculated(inputs: ruckig.InputParameter) -> ruckig.Trajectory:
    """Ruckig's trajectory, or an error that says what it was asked for."""
    trajectory = ruckig.Trajectory(1)
    result = ruckig.Ruckig(1).calculate(inputs, trajectory)
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise MotionError(f"Ruckig found no way along the path ({result}). It was asked for {inputs}.")
    return trajectory


def _law(trajectory: ruckig.Trajectory) -> TimeLaw:
    """The pieces of constant jerk that Ruckig chose, less those of no duration."""
    profile = trajectory.profiles[0][0]
    durations = np.array(profile.t)
    used = durations > 0
    states = np.column_stack([profile.p, profile.v, profile.a])[:-1]
    times: Array = np.concatenate([[0.0], np.cumsum(durations[used])])
    return TimeLaw(times, states[used], np.array(profile.j)[used])
