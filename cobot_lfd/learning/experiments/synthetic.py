"""Made-up tasks like the paper's (section 5.2), for tests and comparisons.

A path starts at the first frame and ends at the last. It leaves an oriented frame along the frame's x axis,
its *slot*, for a length L that is given as a share of the mean distance between the frames (1 m), and
enters an oriented last frame the same way, backwards; between, it follows a cubic Bézier curve whose
handles continue the slots. An orientation-less frame has no slot and its axes lie anyhow. A demonstrator
bows the path sideways, warps its timing and trembles; the truth is the same path without demonstrator.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from cobot_lfd.arrays import Array
from cobot_lfd.demonstration import Demonstration, SpatialDemonstration
from cobot_lfd.frame import Frame
from cobot_lfd.pose import Pose

FINE = 800
"""Points of the polyline that stands for a curve."""


@dataclass(frozen=True, slots=True)
class SyntheticTask:
    """A made-up task and its demonstrator; lengths in [m], angles in [rad].

    Attributes:
        start_oriented: Whether the path leaves the first frame along its slot.
        end_oriented: Whether the path enters the last frame along its slot.
        slot: Length L of a slot, as a share of the mean distance between the frames.
        slot_spread: A slot points within this angle of the line to the other frame.
        loose_spread: An orientation-less frame's x axis points within this angle of a fixed direction.
        via: Whether the path must pass the origin of a third frame, orientation-less, half way.
        irrelevant: Whether there is a further frame that the path does not care about.
        half_box: Half size of the boxes in which the frames lie.
        widen: Factor on the boxes, for scenes beyond the demonstrated ones.
        handle: Length of the Bézier curve's handles, as a share of its chord.
        bell: Whether the speed is bell-shaped (minimum jerk); else it is constant.
        wait: Mean share of the time that the demonstrator waits at either end.
        bow: Greatest sideways bow, as a share of the curve's chord.
        warp: Standard deviation of the timing's exponent.
        noise: Range of the trembling's standard deviation.
        frame_noise: Standard deviation of the frames' recorded positions.
        angle_noise: Standard deviation of the frames' recorded angles.
        dimension: 2 or 3.
    """

    start_oriented: bool = True
    end_oriented: bool = True
    slot: float = 0.25
    slot_spread: float = np.radians(100)
    loose_spread: float = np.pi
    via: bool = False
    irrelevant: bool = False
    half_box: tuple[float, float] = (0.25, 0.4)
    widen: float = 1.0
    handle: float = 0.4
    bell: bool = False
    wait: float = 0.0
    bow: float = 0.12
    warp: float = 0.15
    noise: tuple[float, float] = (0.003, 0.010)
    frame_noise: float = 0.0
    angle_noise: float = 0.0
    dimension: int = 2

    @property
    def leaves_by_slot(self) -> bool:
        """Whether the path leaves the first frame along its slot; without length there is none."""
        return self.start_oriented and self.slot > 0

    @property
    def enters_by_slot(self) -> bool:
        """Whether the path enters the last frame along its slot."""
        return self.end_oriented and self.slot > 0

    @property
    def kinds(self) -> dict[str, bool]:
        """Whether each frame is oriented, by name."""
        kinds = {"start": self.leaves_by_slot, "end": self.enters_by_slot}
        if self.via:
            kinds["via"] = False
        if self.irrelevant:
            kinds["bystander"] = False
        return kinds


TASKS = {
    1: SyntheticTask(),
    2: SyntheticTask(end_oriented=False),
    3: SyntheticTask(start_oriented=False, end_oriented=False),
}
"""The paper's Tasks 1, 2 and 3 with slots of 25 %."""


def paper_like(task: SyntheticTask) -> SyntheticTask:
    """Long slots that point far away, as the path lengths in the paper's Table 4 suggest."""
    return replace(task, slot=0.45, slot_spread=np.radians(140))


def human_timing(task: SyntheticTask) -> SyntheticTask:
    """Bell-shaped speed, and waits at both ends."""
    return replace(task, bell=True, wait=0.08)


def draw_scene(task: SyntheticTask, rng: np.random.Generator) -> dict[str, Pose]:
    """The true frames of a new scene, as poses; planar tasks use their x, y and yaw."""
    half = np.array([*task.half_box, task.half_box[1]])[: task.dimension] * task.widen
    centres = {"start": -0.5, "end": 0.5, "via": 0.0, "bystander": 0.0}
    positions = {}
    for name in task.kinds:
        offset = np.zeros(3)
        offset[: task.dimension] = rng.uniform(-half, half)
        offset[0] += centres[name]
        positions[name] = offset
    if task.via:
        positions["via"][:2] *= np.array([0.6, 1.0])
    other = {"start": "end", "end": "start", "via": "end", "bystander": "end"}
    return {
        name: Pose(positions[name], _axes(task, oriented, positions[other[name]] - positions[name], rng))
        for name, oriented in task.kinds.items()
    }


def true_path(task: SyntheticTask, scene: dict[str, Pose], n_steps: int = 200) -> Array:
    """The path without demonstrator, shape (T, d)."""
    progress = _progress(task, np.linspace(0, 1, n_steps), task.wait, task.wait)
    return _along(_curve(task, scene, (0.0, 0.0)), progress)


def recorded(task: SyntheticTask, scene: dict[str, Pose], rng: np.random.Generator) -> dict[str, Pose]:
    """The frames as a camera reports them, with its noise."""
    return {name: _disturbed(task, pose, rng) for name, pose in scene.items()}


def demonstrate(
    task: SyntheticTask,
    rng: np.random.Generator,
    n_steps: int = 200,
    scene: dict[str, Pose] | None = None,
) -> Demonstration | SpatialDemonstration:
    """A demonstration in the given scene, or in a new one."""
    scene = draw_scene(task, rng) if scene is None else scene
    bows = rng.uniform(-task.bow, task.bow, 2)
    waits = rng.uniform(0.5, 1.5, 2) * task.wait
    progress = _progress(task, np.linspace(0, 1, n_steps), *waits) ** np.exp(rng.normal(0, task.warp))
    path = _along(_curve(task, scene, (bows[0], bows[1])), progress)
    path = path + _tremble(n_steps, task.dimension, rng.uniform(*task.noise), rng)
    frames = recorded(task, scene, rng)
    if task.dimension == 3:
        return SpatialDemonstration(path, frames)
    return Demonstration(path, planar(frames))


def demonstrations(
    task: SyntheticTask, n: int, rng: np.random.Generator, n_steps: int = 200
) -> list[Demonstration | SpatialDemonstration]:
    """A training set of n demonstrations."""
    return [demonstrate(task, rng, n_steps) for _ in range(n)]


def planar(scene: dict[str, Pose]) -> dict[str, Frame]:
    """Poses on the table as planar frames."""
    return {
        name: Frame(pose.position[:2], float(np.arctan2(pose.rotation[1, 0], pose.rotation[0, 0])))
        for name, pose in scene.items()
    }


def _axes(task: SyntheticTask, oriented: bool, towards: Array, rng: np.random.Generator) -> Array:
    """The frame's axes: the x axis near the line to the other frame, or anyhow."""
    spread = task.slot_spread if oriented else task.loose_spread
    if task.dimension == 2:
        heading = np.arctan2(towards[1], towards[0]) if oriented else 0.0
        turn = Rotation.from_euler("z", heading + rng.uniform(-spread, spread))
        return np.asarray(turn.as_matrix())
    if not oriented:
        return np.asarray(Rotation.random(rng=rng).as_matrix())
    tilt = rng.uniform(0, spread)
    side = np.cross(towards, rng.normal(size=3))
    direction = Rotation.from_rotvec(tilt * side / np.linalg.norm(side)).apply(towards)
    first = Rotation.align_vectors([direction], [[1.0, 0.0, 0.0]])[0]
    return np.asarray((first * Rotation.from_euler("x", rng.uniform(-np.pi, np.pi))).as_matrix())


def _curve(task: SyntheticTask, scene: dict[str, Pose], bows: tuple[float, float]) -> Array:
    """The whole path as a fine polyline of the task's dimension."""
    slot_start = task.slot * task.leaves_by_slot
    slot_end = task.slot * task.enters_by_slot
    stops = [scene["start"].apply([slot_start, 0, 0]), scene["end"].apply([slot_end, 0, 0])]
    if task.via:
        stops.insert(1, scene["via"].position)
    out_of = scene["start"].rotation[:, 0] if task.leaves_by_slot else None
    into = scene["end"].rotation[:, 0] if task.enters_by_slot else None
    headings = [out_of, *([None] if task.via else []), None if into is None else -into]
    if task.via:
        across = stops[2] - stops[0]
        headings[1] = across / np.linalg.norm(across)
    legs = [
        _bezier(task, stops[i], stops[i + 1], headings[i], headings[i + 1], bows[i])
        for i in range(len(stops) - 1)
    ]
    parts = [scene["start"].position[None], *legs, scene["end"].position[None]]
    return np.concatenate(parts)[:, : task.dimension]


def _bezier(
    task: SyntheticTask, start: Array, end: Array, leaving: Array | None, arriving: Array | None, bow: float
) -> Array:
    """A cubic Bézier curve between two points; where a heading is free, it looks at the other handle."""
    chord = float(np.linalg.norm(end - start))
    reach = task.handle * chord
    first = None if leaving is None else start + reach * leaving
    second = None if arriving is None else end - reach * arriving
    if first is None:
        first = start + reach * _unit((end if second is None else second) - start)
    if second is None:
        second = end + reach * _unit(first - end)
    u = np.linspace(0, 1, FINE)[:, None]
    points = (1 - u) ** 3 * start + 3 * u * (1 - u) ** 2 * first + 3 * u**2 * (1 - u) * second + u**3 * end
    side = np.array([-(end - start)[1], (end - start)[0], 0.0])
    return np.asarray(points + bow * side * np.sin(np.pi * u) ** 2)


def _unit(vector: Array) -> Array:
    """The same direction with length 1."""
    return np.asarray(vector / max(float(np.linalg.norm(vector)), 1e-12))


def _progress(task: SyntheticTask, times: Array, wait_start: float, wait_end: float) -> Array:
    """Share of the path's length that is done at normalised times."""
    u = np.clip((times - wait_start) / (1 - wait_start - wait_end), 0, 1)
    return 10 * u**3 - 15 * u**4 + 6 * u**5 if task.bell else u


def _along(polyline: Array, progress: Array) -> Array:
    """Points at shares of a polyline's length."""
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(polyline, axis=0), axis=1))])
    return np.stack([np.interp(progress * length[-1], length, axis) for axis in polyline.T], axis=1)


def _tremble(n_steps: int, dimension: int, size: float, rng: np.random.Generator) -> Array:
    """Smooth noise of the given standard deviation."""
    raw = gaussian_filter1d(rng.normal(size=(n_steps, dimension)), 0.02 * n_steps, axis=0, mode="reflect")
    return np.asarray(raw / raw.std() * size)


def _disturbed(task: SyntheticTask, pose: Pose, rng: np.random.Generator) -> Pose:
    """A pose with the camera's noise."""
    shift = np.zeros(3)
    shift[: task.dimension] = rng.normal(0, task.frame_noise, task.dimension)
    turn = np.array([0.0, 0.0, rng.normal(0, task.angle_noise)])
    if task.dimension == 3:
        turn = rng.normal(0, task.angle_noise, 3)
    return Pose(pose.position + shift, Rotation.from_rotvec(turn).as_matrix() @ pose.rotation)
