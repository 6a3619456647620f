"""A session in the studio: what its buttons do, in the one thread that owns the simulation."""

from collections.abc import Callable
from pathlib import Path
from time import sleep

from cobot_lfd.app.episode import Bench, run_episode
from cobot_lfd.app.execute import Observer
from cobot_lfd.app.recording.replay import replay_in
from cobot_lfd.app.studio.audience import Audience, Mode
from cobot_lfd.app.studio.coverage import suggest_next
from cobot_lfd.app.studio.inbox import Cancelled, Inbox
from cobot_lfd.app.studio.keeper import Keeper
from cobot_lfd.app.studio.kept import Kept
from cobot_lfd.app.studio.stage import Stage
from cobot_lfd.errors import CobotError
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.outcome import Outcome, Verdict
from robots import Kinematics, load_robot
from scenes import World, load_scene

_LOOK = 1.5  # [s] for which the end of a replay or a trial stays to be looked at


class Session:
    """What happens in the studio, order by order.

    Orders come from other threads through ``order``; all else happens in the thread that calls ``run``.

    Attributes:
        stage: Table, arm and hand.
        mode: What is going on.
        keeper: What is recorded, and what was kept.
        model: What was learnt; None before that.
        path: The path that the model has for the present scene.
    """

    def __init__(
        self, scene_name: str, robot_name: str, folder: Path, first_seed: int, audience: Audience
    ) -> None:
        """Prepare a session.

        Args:
            scene_name: Name of the scene.
            robot_name: Name of the robot.
            folder: Where demonstrations are kept; what is in it already stays.
            first_seed: Of the first scene; seeds that the folder has are left out.
            audience: Who sees it.

        Raises:
            DescriptionError: If there is no such scene or robot.
            DataError: If the folder holds demonstrations of another scene or robot, or cannot be written.
        """
        scene = load_scene(scene_name)
        robot = load_robot(robot_name, scene.task.tool)
        self._scene_name, self._robot_name = scene_name, robot_name
        self._audience = audience
        self._inbox = Inbox()
        self.mode = Mode.WORKING
        self.keeper = Keeper(scene_name, robot_name, folder)
        self.model: TaskParameterisedGMM | None = None
        self.path: GeneratedPath | None = None
        self.stage = Stage(scene, robot, self.keeper.fresh_seed(first_seed), audience)

    @property
    def latencies(self) -> list[float]:
        """From the arrival of each pointer event to the force on the arm [s], the latest ones."""
        return list(self.stage.latencies)

    @property
    def kept(self) -> Kept:
        """The demonstrations in the folder."""
        return self.keeper.kept

    @property
    def is_open(self) -> bool:
        """Whether it goes on."""
        return self._inbox.is_open

    def order(self, what: Callable[[], None]) -> None:
        """Ask for something to be done, from any thread; it is done between two steps of the simulation."""
        self._inbox.put(what)

    def run(self) -> None:
        """Work until the session is closed."""
        try:
            self.stage.show()
            self._do(self._get_ready)
            while self.is_open:
                self.stage.lead(self._inbox.until_ordered(self.stage.hand), self.keeper.recorder)
                while self.is_open and self._inbox.waits:
                    self._do(self._inbox.take())
        finally:
            self._keep_incomplete()
            self.stage.close()

    def close(self) -> None:
        """End the session; what is being recorded is kept, labelled as incomplete."""
        self._inbox.close()

    def start(self) -> None:
        """Begin to record; where the scene was touched, it is laid out anew first."""
        if self.keeper.recorder is not None:
            return
        if self.stage.touched:
            self._lay_out(self.stage.seed)
        self.stage.begin()
        self.keeper.begin(self.stage.scene.physics.time_step)
        self._set_mode(Mode.RECORDING)

    def stop(self) -> None:
        """End the recording, let the physics judge it, and keep it: nothing is lost from here on."""
        if self.keeper.recorder is None:
            return
        self._set_mode(Mode.WORKING)
        self._save(self.stage.judge())
        self._set_mode(Mode.STOPPED)

    def discard(self, number: int) -> None:
        """Move a demonstration to the trash."""
        path = self.keeper.discard(number)
        self._tell(f"Moved to {path}. Undo brings it back.")

    def discard_last(self) -> None:
        """Move the demonstration that was recorded last to the trash."""
        if self.keeper.last is not None:
            self.discard(self.keeper.last)

    def undo(self) -> None:
        """Bring back what was discarded last."""
        path = self.keeper.undo()
        self._tell("There is nothing to undo." if path is None else f"Back again: {path}.")

    def redo(self) -> None:
        """Discard the last demonstration, or the one that is being recorded, and record the scene again."""
        self._keep_incomplete()
        self.discard_last()
        self._lay_out(self.stage.seed)
        self.start()

    def next_scene(self) -> None:
        """Go on with the scene that tells most, and say why."""
        demonstrations = [episode.demonstration() for episode in self.kept.good]
        first = self.keeper.fresh_seed(self.stage.seed + 1)
        following = suggest_next(self.stage.scene, first, demonstrations)
        self._audience.said(f"Next scene, seed {following.seed}. {following.reason}")
        self.lay_out(following.seed)

    def lay_out(self, seed: int) -> None:
        """Lay out the scene of a seed."""
        self._keep_incomplete()
        self._lay_out(seed)

    def replay(self, number: int) -> None:
        """Show a demonstration again, from its joint states, in its own scene; then come back."""
        episode, here = self.kept.episodes[number], self.stage.seed
        self._keep_incomplete()
        self._set_mode(Mode.REPLAYING)
        try:
            self.stage.build(episode.seed)
            world, arm = self.stage.world, self.stage.arm
            result = replay_in(
                world, arm, episode, "joints", observer=self._inbox.interrupting(self.stage.observe)
            )
            self._audience.said(
                f"Demonstration {number} again: the tool deviates by {1000 * result.worst:.1f} mm at most; "
                f"{result.verdict.sentence}."
            )
            sleep(_LOOK)
        except Cancelled:
            self._audience.said("The replay was stopped.")
        self._lay_out(here)

    def learn(self) -> None:
        """Fit a model to what is kept, and generate its path for this scene."""
        demonstrations = [episode.demonstration() for episode in self.kept.good]
        if len(demonstrations) < 2:
            self._audience.said("Learning needs two demonstrations that did the task, or more.", bad=True)
            return
        mode = self.mode
        self._set_mode(Mode.WORKING)
        self.model = TaskParameterisedGMM.fit(demonstrations)
        self._generate()
        self._audience.said(f"Learnt from {len(demonstrations)} demonstrations.")
        self._set_mode(mode)

    def try_it(self) -> None:
        """Let the arm perform the task in this scene as it has learnt it."""
        if self.model is None:
            self.learn()
        if self.model is None:
            return
        self._keep_incomplete()
        self._set_mode(Mode.TRYING)
        stage = self.stage
        try:
            with Kinematics(stage.robot) as kinematics:
                bench = Bench(
                    scene_name=self._scene_name,
                    robot_name=self._robot_name,
                    scene=stage.scene,
                    robot=stage.robot,
                    kinematics=kinematics,
                    model=self.model,
                )
                verdict = run_episode(bench, stage.seed, film=self._film).result.verdict
            self._audience.said(f"The arm tried it: {verdict.sentence}.", bad=not verdict.succeeded)
            sleep(_LOOK)
        except Cancelled:
            self._audience.said("The trial was stopped.")
        self._lay_out(stage.seed)

    def abandoned(self) -> None:
        """Nobody is there any more: the arm rests, and what was recorded is kept as incomplete."""
        self.stage.hand.let_go()
        if self.keeper.recorder is not None:
            self._keep_incomplete()
            self._set_mode(Mode.STOPPED)

    def _do(self, what: Callable[[], None]) -> None:
        """Carry out an order; what the person can mend is told."""
        try:
            what()
        except CobotError as error:
            self._audience.said(str(error), bad=True)
            self._set_mode(Mode.RECORDING if self.keeper.recorder is not None else Mode.READY)

    def _lay_out(self, seed: int) -> None:
        """A fresh scene, the arm where a person takes its hand."""
        self._set_mode(Mode.WORKING)
        self.path = None
        self.stage.build(seed)
        self._get_ready()

    def _get_ready(self) -> None:
        self._generate()
        self.stage.get_ready()
        self._set_mode(Mode.READY)

    def _generate(self) -> None:
        """The path that the model has for this scene, where the camera saw what it needs."""
        if self.model is not None and not self.stage.view.missing:
            self.path = self.model.reproduce(self.stage.view.frames)

    def _save(self, verdict: Verdict) -> None:
        """Keep what was recorded; it is safe on the disk when this returns, or still being recorded."""
        path = self.keeper.save(self.stage, verdict)
        if path is not None:
            self.stage.touched = True
            self._tell(f"Kept as {path}: {verdict.sentence}.", bad=not verdict.succeeded)

    def _keep_incomplete(self) -> None:
        """Keep a recording that nobody ended, labelled so."""
        self._save(Verdict(Outcome.INCOMPLETE, "nobody ended it"))

    def _tell(self, sentence: str, *, bad: bool = False) -> None:
        """Say what happened, and show what is kept now."""
        self._audience.said(sentence, bad=bad)
        self._audience.changed(self)

    def _set_mode(self, mode: Mode) -> None:
        self.mode = mode
        self._audience.changed(self)

    def _film(self, world: World) -> Observer:
        return self._inbox.interrupting(self.stage.film(world))
