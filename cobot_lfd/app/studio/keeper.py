"""Who keeps what is recorded: nothing of it is lost, and nothing that was kept is deleted."""

from dataclasses import replace
from pathlib import Path

from cobot_lfd.app.demonstrations.folder import restore_episode, trash_episode
from cobot_lfd.app.demonstrations.store import episode_number, require_writable, save_episode
from cobot_lfd.app.recording.carry import trimmed_carry
from cobot_lfd.app.recording.record import seeds_in
from cobot_lfd.app.recording.recorder import Recorder
from cobot_lfd.app.studio.kept import Kept
from cobot_lfd.app.studio.stage import Stage
from cobot_lfd.outcome import Verdict


class Keeper:
    """The recording that goes on, and the folder to which it goes.

    Attributes:
        recorder: Of what is being recorded; None where nothing is.
        kept: The demonstrations in the folder.
        last: Number of the demonstration that was recorded last; None where it was discarded.
    """

    def __init__(self, scene_name: str, robot_name: str, folder: Path) -> None:
        """Look at a folder.

        Args:
            scene_name: Name of the scene that will be recorded.
            robot_name: Name of the robot.
            folder: Where demonstrations are kept; what is in it already stays.

        Raises:
            DataError: If the folder holds demonstrations of another scene or robot, or cannot be written.
        """
        seeds_in(folder, scene_name, robot_name)
        require_writable(folder)
        self._scene_name, self._robot_name, self._folder = scene_name, robot_name, folder
        self._discarded: list[int] = []
        self.recorder: Recorder | None = None
        self.kept = Kept.read(folder)
        self.last: int | None = None

    @property
    def can_undo(self) -> bool:
        """Whether something was discarded that can be brought back."""
        return bool(self._discarded)

    def begin(self, time_step: float) -> None:
        """Begin to record a physics of a time step [s]."""
        self.recorder = Recorder(time_step)

    def save(self, stage: Stage, verdict: Verdict) -> Path | None:
        """Keep what was recorded on a stage, with a verdict: it is safe on the disk when this returns.

        Returns:
            The file; None where nothing was recorded.

        Raises:
            DataError: If it could not be saved; then the recording still goes on.
        """
        recorder, view = self.recorder, stage.view
        if recorder is None or recorder.n_samples < 2:
            self.recorder = None
            return None
        recorded = recorder.episode(
            self._scene_name,
            self._robot_name,
            stage.seed,
            verdict,
            view.picture,
            view.detections,
            stage.scene.camera.camera,
        )
        episode = replace(recorded, carrying=trimmed_carry(recorded.carrying, recorded.tool_positions))
        path = save_episode(self._folder, episode)
        self.recorder = None
        self.last = episode_number(path)
        self.kept = Kept.read(self._folder)
        return path

    def discard(self, number: int) -> Path:
        """Move a demonstration to the trash; returns the file there."""
        path = trash_episode(self._folder, number)
        self._discarded.append(number)
        if self.last == number:
            self.last = None
        self.kept = Kept.read(self._folder)
        return path

    def undo(self) -> Path | None:
        """Bring back what was discarded last; None where there is nothing."""
        if not self._discarded:
            return None
        path = restore_episode(self._folder, self._discarded[-1])
        self.last = self._discarded.pop()
        self.kept = Kept.read(self._folder)
        return path

    def fresh_seed(self, first: int) -> int:
        """The first seed, counted from one on, that no demonstration has."""
        taken = {episode.seed for episode in self.kept.episodes.values()}
        return next(seed for seed in range(first, first + len(taken) + 1) if seed not in taken)
