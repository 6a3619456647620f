"""The table, the arm and the person's hand, in real time, shown to an audience."""

from collections import deque
from time import perf_counter
from typing import Any

import numpy as np

from cobot_lfd.app.execute import Observer
from cobot_lfd.app.perceive import View, perceive
from cobot_lfd.app.recording.guided_hand import GuidedHand
from cobot_lfd.app.recording.hand import Hand
from cobot_lfd.app.recording.record import lead
from cobot_lfd.app.recording.recorder import Recorder
from cobot_lfd.app.studio.audience import Audience
from cobot_lfd.app.studio.clock import Clock
from cobot_lfd.app.turns import turn_choices
from cobot_lfd.motion import move
from cobot_lfd.outcome import Outcome, Verdict
from robots import Arm, RobotDescription
from scenes import SceneDescription, World, check_success

_SHOWN_EVERY = 1 / 30  # [s] between two pictures of the arm on the page
_READY_SHARE = 0.3  # of the joints' limits, when the arm goes where the person takes its hand


class Stage:
    """One scene after the other, laid out from seeds.

    Attributes:
        scene: The scene.
        robot: The robot.
        seed: Lays out the present scene.
        world: The present scene in the simulator.
        arm: The arm in it.
        view: What the camera saw of it.
        hand: The person's hand; may be moved from any thread.
        clock: Of the simulation.
        touched: Whether anybody pulled since the scene was laid out.
        audience: Who sees it.
        shown_tool: Where the tool was when it was shown last [m], shape (3,).
        latencies: From the arrival of a pointer event to the force on the arm [s], the latest ones.
        robot_body: Number of the body that is shown as the robot.
    """

    def __init__(
        self, scene: SceneDescription, robot: RobotDescription, seed: int, audience: Audience
    ) -> None:
        self.scene, self.robot, self.seed = scene, robot, seed
        self.audience = audience
        self.latencies: deque[float] = deque(maxlen=10_000)
        self.shown_tool = np.zeros(3)
        self._shown_at = 0.0
        self.clock = Clock(scene.physics.time_step)
        self.hand = self._new_hand()
        self.touched = False
        self.world = World(scene, seed)
        self.arm = Arm(self.world.client, robot)
        self.robot_body = self.arm.body.id
        self.view: View = perceive(self.world)

    def close(self) -> None:
        """End the simulation."""
        self.world.close()

    def build(self, seed: int) -> None:
        """Lay out the scene of a seed, the arm parked; the camera looks again only where the seed is new."""
        same = seed == self.seed
        self.world.close()
        self.seed = seed
        self.world = World(self.scene, seed)
        self.arm = Arm(self.world.client, self.robot)
        if not same:
            self.view = perceive(self.world)
        self.show()

    def begin(self) -> None:
        """The scene afresh and the arm at rest where it is: what a hand does from now on can be done again.

        A replay starts in a world that has just been built. Only if the recording did so, too, are the two
        equal to the last bit.
        """
        positions, _ = self.arm.body.joint_states()
        self.world.close()
        self.world = World(self.scene, self.seed)
        self.arm = Arm(self.world.client, self.robot)
        self.arm.body.place(positions)
        self.touched = False
        self.clock.restart()

    def show(self) -> None:
        """Show the scene as it is."""
        self.touched = False
        self.robot_body = self.arm.body.id
        self.clock.restart()
        self.audience.scene_changed(self.world, self.robot_body, self.view)

    def get_ready(self) -> None:
        """Move the arm from where it is parked to where a person takes its hand."""
        limits = self.robot.joint_limits.scaled(
            velocity=_READY_SHARE, acceleration=_READY_SHARE, jerk=_READY_SHARE
        )
        way = move(np.array(self.robot.parked), np.array(self.robot.home), limits)
        samples = way.every(self.scene.physics.time_step)
        self.clock.restart()
        for position, velocity in zip(samples.positions, samples.velocities, strict=True):
            self.arm.follow(position, velocity)
            self._step()
        guide = self.hand.guide
        self.hand = self._new_hand()
        self.hand.guide = guide

    def lead(self, hand: Hand, recorder: Recorder | None) -> None:
        """Let a hand lead the arm until it is done."""
        self.clock.restart()
        lead(self.world, self.arm, hand, recorder, observer=self.observe)

    def judge(self) -> Verdict:
        """Whether what was shown can be learnt from: the task is done, and the camera saw the objects."""
        if self.view.missing:
            missing = self.view.missing[0]
            return Verdict(Outcome.OBJECT_NOT_SEEN, f"{missing.name}: {missing.reason}")
        self.arm.hold()
        return check_success(self.world, (self.arm.body.id,), step=self._step)

    def align(self) -> None:
        """Turn the tool as the part asks for, or, with a part, as its goal does."""
        if not self.view.missing:
            rotation = self.arm.state().world_from_tool.rotation
            yaw = float(np.arctan2(rotation[1, 0], rotation[0, 0]))
            turn = turn_choices(self.scene.task, self.view.frames, yaw)[0]
            self.hand.turn_to(turn.end if self.hand.is_closed else turn.start)

    def observe(self) -> None:
        """After every step: wait for the clock on the wall, and show what is to be seen."""
        self.watch(self.world.client)
        self.touched = self.touched or self.hand.pulls or self.hand.is_closed

    def watch(self, client: Any) -> None:
        """The same for a world that belongs to someone else."""
        self.clock.step()
        now = perf_counter()
        if now - self._shown_at >= _SHOWN_EVERY:
            self._shown_at = now
            state = client.getLinkState(self.robot_body, self.arm.body.tool, computeForwardKinematics=True)
            self.shown_tool = np.array(state[4])
            self.audience.moved(client, self)

    def film(self, world: World) -> Observer:
        """Show a world that belongs to someone else; called after each of its steps."""
        client = world.client
        bodies = [client.getBodyUniqueId(i) for i in range(client.getNumBodies())]
        self.robot_body = max(bodies, key=client.getNumJoints)
        self.audience.scene_changed(world, self.robot_body, self.view)
        self.clock.restart()
        return lambda: self.watch(client)

    def _step(self) -> None:
        self.world.step()
        self.observe()

    def _new_hand(self) -> GuidedHand:
        step = self.scene.physics.time_step
        return GuidedHand(self.scene.task, self.robot.gripper.maximum_opening, step, self.latencies)
