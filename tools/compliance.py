"""An arm that gives way where the learnt path is loose: pushed while it carries, stiff and compliant."""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import tyro
from tyro.conf import Positional

from cobot_lfd.app.compliance import Compliance
from cobot_lfd.app.episode import run_episode
from cobot_lfd.app.evaluate import Job, bench_for
from scenes import World

LIFTED = 0.08  # [m]; a part above this height is being carried


def main(
    model: Positional[Path],
    *,
    scene: str = "pick_and_place",
    robot: str = "panda",
    push: float = 3.0,
    seed: int = 0,
) -> int:
    """Carry a part that somebody pushes sideways, stiff and compliant, and print how far it strays.

    Args:
        model: File of a learnt model.
        scene: Name of the scene.
        robot: Name of the robot.
        push: Force along the world's x axis [N].
        seed: Decides the scene's layout.
    """
    stiff = bench_for(Job(scene, robot, model))
    compliant = replace(stiff, compliance=Compliance())
    for name, bench, force in (
        ("stiff", stiff, push),
        ("compliant", compliant, push),
        ("compliant", compliant, 0.0),
    ):
        result = run_episode(bench, seed, film=_pushing(stiff.scene.task.pick, force)).result
        strayed = 1000 * result.metrics.get("tracking_error", float("nan"))
        print(f"{name}, pushed by {force:.0f} N: strays by {strayed:.1f} mm; {result.verdict.sentence}")
    return 0


def _pushing(name: str, force: float) -> Callable[[World], Callable[[], None]]:
    """Pushes an object that is off the table, after each step for the next."""

    def begin(world: World) -> Callable[[], None]:
        def push() -> None:
            centre = world.true_centre(name).position
            if centre[2] > LIFTED:
                world.client.applyExternalForce(
                    world.bodies[name], -1, [force, 0.0, 0.0], centre.tolist(), world.client.WORLD_FRAME
                )

        return push

    return begin


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
