"""How good a demonstration is to learn from: duration, smoothness, and what a person should look at."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.arrays import Array
from cobot_lfd.errors import DescriptionError
from robots import RobotDescription, load_robot
from scenes import SceneDescription, load_scene

_NEAR = 0.03  # [m] within which a carry should begin at the part and end at its goal
_AT_LIMIT = 0.02  # [rad] from a joint's limit that counts as at it
_STILL = 0.005  # [m/s] below which the hand stands
_LONG_STOP = 0.5  # [s]
_PLANE = 0.03  # [m] by which the height of a planar carry may vary
_CUT_OFF, _FAINT = 10.0, 0.05  # [Hz] and share of the largest amplitude, as in the source of SPARC


@dataclass(frozen=True, slots=True)
class Quality:
    """What a list of demonstrations says about one.

    Attributes:
        duration: From the first sample to the last [s].
        carried: Length of the planar carry [m].
        smoothness: Spectral arc length of the carry's speed; about -1.5 for a smooth reach, lower for a jerky
            one; None where too little was carried.
        warnings: What a person should look at, each a short sentence.
    """

    duration: float
    carried: float
    smoothness: float | None
    warnings: tuple[str, ...]


def assess(episode: RecordedEpisode) -> Quality:
    """Measure a demonstration; what its scene and robot would add is left out where they are unknown."""
    path, times = episode.tool_positions[episode.carrying], episode.times[episode.carrying]
    speed = _speed(path[:, :2], times)
    return Quality(
        duration=float(np.ptp(episode.times)) if len(episode.times) else 0.0,
        carried=float(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1).sum()),
        smoothness=spectral_arc_length(speed, times) if len(speed) > 3 else None,
        warnings=tuple(_warnings(episode, path, times, speed)),
    )


def spectral_arc_length(speed: Array, times: Array) -> float:
    """Smoothness of a movement: minus the arc length of its speed's normalised amplitude spectrum.

    Balasubramanian, Melendez-Calderon, Roby-Brami, Burdet: On the analysis of movement smoothness (2015),
    with their cut-off of 10 Hz and amplitude threshold of 0.05. It depends neither on the movement's size
    nor, for movements of one shape, on its duration.

    Args:
        speed: Speed [m/s], at equal steps of time, shape (M,).
        times: Times [s], shape (M,).
    """
    n = 16 * 2 ** int(np.ceil(np.log2(len(speed))))
    step = float(np.median(np.diff(times)))
    frequencies, amplitudes = np.fft.rfftfreq(n, step), np.abs(np.fft.rfft(speed, n))
    if amplitudes[0] == 0.0:
        return 0.0
    inside = frequencies <= _CUT_OFF
    frequencies, amplitudes = frequencies[inside], amplitudes[inside] / amplitudes[0]
    last = int(np.flatnonzero(amplitudes >= _FAINT)[-1]) + 1
    if last < 2:
        return 0.0
    share = np.diff(frequencies[:last]) / frequencies[last - 1]
    return -float(np.hypot(share, np.diff(amplitudes[:last])).sum())


def _speed(path: Array, times: Array) -> Array:
    """Speed along a path [m/s], one value per sample."""
    if len(path) < 2:
        return np.zeros(len(path))
    return np.asarray(np.linalg.norm(np.gradient(path, times, axis=0), axis=1))


def _warnings(episode: RecordedEpisode, path: Array, times: Array, speed: Array) -> Iterator[str]:
    scene, robot = _known(episode)
    if len(path) < 2:
        yield "nothing was carried"
        return
    if scene is not None:
        yield from _far_ends(episode, scene, path)
    if robot is not None:
        yield from _joints_at_limits(episode, robot)
    stop = _longest_stop(times, speed)
    if stop > _LONG_STOP:
        yield f"stands still for {stop:.1f} s on the way"
    if np.ptp(path[:, 2]) > _PLANE:
        yield f"its height varies by {100 * np.ptp(path[:, 2]):.0f} cm"


def _known(episode: RecordedEpisode) -> tuple[SceneDescription | None, RobotDescription | None]:
    """Scene and robot of an episode; None for one that this program does not have."""
    scene, robot = None, None
    try:
        scene = load_scene(episode.scene)
        robot = load_robot(episode.robot, scene.task.tool)
    except DescriptionError:
        pass
    return scene, robot


def _far_ends(episode: RecordedEpisode, scene: SceneDescription, path: Array) -> Iterator[str]:
    frames = {detection.name: detection.frame for detection in episode.detections}
    ends = (("starts", scene.task.waypoints[0], path[0]), ("ends", scene.task.waypoints[-1], path[-1]))
    for what, waypoint, point in ends:
        if waypoint.frame not in frames:
            yield f"the camera did not see the {waypoint.frame}"
            continue
        goal = frames[waypoint.frame].apply(waypoint.position)
        distance = float(np.linalg.norm(goal - point[:2]))
        if distance > _NEAR:
            yield f"{what} {100 * distance:.0f} cm from the {waypoint.frame}"


def _joints_at_limits(episode: RecordedEpisode, robot: RobotDescription) -> Iterator[str]:
    lower, upper = np.array(robot.limits.position_lower), np.array(robot.limits.position_upper)
    if episode.joint_positions.shape[1] != len(lower):
        return
    room = np.minimum(episode.joint_positions - lower, upper - episode.joint_positions).min(axis=0)
    for joint in np.flatnonzero(room < _AT_LIMIT):
        yield f"joint {joint + 1} at its limit"


def _longest_stop(times: Array, speed: Array) -> float:
    """Longest time for which the hand stands between its first and its last movement [s]."""
    moving = np.flatnonzero(speed > _STILL)
    return float(np.diff(times[moving]).max()) if len(moving) > 1 else 0.0
