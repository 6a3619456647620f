"""What is evaluated with one model, and what its episodes share."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from cobot_lfd.app.compliance import Compliance
from cobot_lfd.app.episode import Bench
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.motion import TimingMethod
from robots import Kinematics, load_robot
from scenes import load_scene


@dataclass(frozen=True, slots=True)
class Job:
    """What is evaluated; small enough to be sent to another process.

    Attributes:
        scene: Name of the scene.
        robot: Name of the robot.
        model: File of the model.
        covered: Whether something covers the camera's lens.
        compliant: Whether the arm gives way during the carry where the demonstrations strayed.
        timing: How the motion along the path gets its times.
        camera: File of the calibrated camera by which pictures are read; the scene's by default.
    """

    scene: str
    robot: str
    model: Path
    covered: bool = False
    compliant: bool = False
    timing: TimingMethod = "simple"
    camera: Path | None = None


@lru_cache(maxsize=4)
def bench_for(job: Job) -> Bench:
    """What all episodes of a job share, read once in each process.

    Raises:
        DescriptionError: If there is no such scene or robot.
        ModelError: If the model cannot be read.
    """
    scene = load_scene(job.scene, calibration=job.camera)
    robot = load_robot(job.robot, scene.task.tool)
    return Bench(
        scene_name=job.scene,
        robot_name=job.robot,
        scene=scene,
        robot=robot,
        kinematics=Kinematics(robot),
        model=TaskParameterisedGMM.load(job.model),
        covered=job.covered,
        compliance=Compliance() if job.compliant else None,
        timing=job.timing,
    )
