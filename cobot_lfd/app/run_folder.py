"""A folder for one evaluation: its plan, where it came from, and a line per episode as it ends."""

import fcntl
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from cobot_lfd.app.disk import told, write_file
from cobot_lfd.app.evaluation.perform import Performed
from cobot_lfd.app.evaluation.plan import Plan, Trial, fingerprints
from cobot_lfd.app.provenance import Provenance
from cobot_lfd.app.result_log import ResultWriter, read_results
from cobot_lfd.app.results import EpisodeResult
from cobot_lfd.app.summary import Summary
from cobot_lfd.errors import DataError

PLAN, RESULTS, SUMMARY, PROVENANCE = "plan.json", "results.jsonl", "summary.json", "provenance.json"
_INPUTS, _PICTURES, _VIDEOS = "inputs", "pictures", "videos"


@dataclass(frozen=True, slots=True)
class RunFolder:
    """An evaluation on disk, made by ``create`` or ``open``.

    Attributes:
        path: The folder.
        plan: What is run.
    """

    path: Path
    plan: Plan

    @classmethod
    def create(cls, path: Path, plan: Plan, provenance: Provenance) -> "RunFolder":
        """Write a plan with all that it needs into a new folder.

        Raises:
            DataError: If the folder holds a run already, or cannot be written.
        """
        if (path / PLAN).exists() or (path / RESULTS).exists():
            raise DataError(
                f"{path} holds an evaluation already; go on with it by --resume {path}, "
                "or choose another folder."
            )
        with told(path, "write results to"):
            (path / _INPUTS).mkdir(parents=True, exist_ok=True)
        for contender in plan.contenders:
            write_file(path / _INPUTS / contender.sha256, contender.content)
        provenance.save(path / PROVENANCE)
        write_file(path / PLAN, f"{plan.to_json()}\n".encode())
        return cls(path, plan)

    @classmethod
    def open(cls, path: Path) -> "RunFolder":
        """Read the plan of a folder.

        Raises:
            DataError: If the folder holds no plan, or it is damaged.
        """
        if not (path / PLAN).is_file():
            raise DataError(f"{path} holds no evaluation (no {PLAN}); check the name.")
        with told(path, "read"):
            text = (path / PLAN).read_text(encoding="utf-8")
            contents = {file.name: file.read_bytes() for file in (path / _INPUTS).iterdir()}
        return cls(path, Plan.from_json(text, contents))

    def results(self) -> tuple[EpisodeResult, ...]:
        """The results so far, in the plan's order.

        Raises:
            DataError: If a line is damaged or belongs to another run.
        """
        if not (self.path / RESULTS).exists():
            return ()
        results = read_results(self.path / RESULTS).results
        for result in results:
            if result.run != self.plan.run:
                raise DataError(f"{self.path / RESULTS}: trial {result.trial} belongs to another run.")
        return tuple(sorted(results, key=lambda result: result.trial))

    def remaining(self) -> list[Trial]:
        """The trials that have no result yet."""
        done = {result.trial for result in self.results()}
        return [trial for trial in self.plan.trials() if trial.number not in done]

    def require_unchanged(self) -> None:
        """Refuse to go on where a scene or robot is no longer what it was; old and new would not compare.

        Raises:
            DataError: If a description has changed.
        """
        now = fingerprints(self.plan.scenes, self.plan.robots)
        changed = [name for name, checksum in self.plan.fingerprints.items() if now.get(name) != checksum]
        if changed:
            raise DataError(
                f"{', '.join(changed)} changed since {self.path} was begun; "
                "start a new run in another folder."
            )

    def picture(self, trial: int) -> Path:
        """File of the picture of a failed trial."""
        return self.path / _PICTURES / f"{trial}.webp"

    def video(self, trial: int) -> Path:
        """File of the video of a failed trial."""
        return self.path / _VIDEOS / f"{trial}.webm"

    def carry_out(
        self,
        drive: Callable[[Sequence[Trial]], Iterator[Performed]],
        report: Callable[[EpisodeResult], None] | None = None,
    ) -> Summary:
        """Run what remains of the plan and keep every result as soon as it is there.

        Args:
            drive: Runs trials.
            report: Called with each new result.

        Raises:
            DataError: If another process works on this folder, or it cannot be written.
        """
        with _alone_in(self.path):
            remaining = self.remaining()
            with ResultWriter(self.path / RESULTS) as writer:
                for performed in drive(remaining):
                    self._keep(performed, writer)
                    if report is not None:
                        report(performed.result)
            return self._finish()

    def _keep(self, performed: Performed, writer: ResultWriter) -> None:
        """Pictures first: where there is a line, its picture is there, too."""
        result = performed.result
        files = {self.picture(result.trial): performed.picture, self.video(result.trial): performed.video}
        for file, content in files.items():
            if content:
                file.parent.mkdir(exist_ok=True)
                write_file(file, content)
        writer.write(result)

    def _finish(self) -> Summary:
        """Put the lines into the plan's order, so that equal runs leave equal files."""
        results = self.results()
        lines = "".join(f"{result.to_json()}\n" for result in results)
        write_file(self.path / RESULTS, lines.encode())
        summary = Summary.of(results)
        write_file(self.path / SUMMARY, f"{summary.to_json()}\n".encode())
        return summary


@contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """Be the only process that works on a run; the system gives the lock back when a process dies."""
    descriptor = os.open(folder / ".lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        os.close(descriptor)
        raise DataError(f"another process works on {folder}; wait until it has ended.") from error
    try:
        yield
    finally:
        os.close(descriptor)
