"""Where results come from: all that is needed to run the same again."""

import hashlib
import json
import platform
import re
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from cobot_lfd.app.disk import told, write_file

DISTRIBUTION = "cobot-lfd"


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """What was run, with what.

    Attributes:
        version: Version of this program.
        commit: Git commit of the checkout it ran from; None if it was not run from one.
        modified: Whether the checkout differed from its commit; None if it was not run from one.
        seeds: Seeds of the episodes.
        options: The command's options by name, as JSON can hold them.
        model: Name of the model's file; None if there is no model.
        model_sha256: Checksum of that file; None if there is no model.
        packages: Version of each package that this program needs.
        python: Version of Python.
        machine: Operating system and processor.
    """

    version: str
    commit: str | None
    modified: bool | None
    seeds: tuple[int, ...]
    options: Mapping[str, Any]
    model: str | None
    model_sha256: str | None
    packages: Mapping[str, str]
    python: str
    machine: str

    @classmethod
    def collect(
        cls,
        *,
        seeds: Sequence[int],
        options: Mapping[str, Any],
        model: Path | None = None,
    ) -> "Provenance":
        """Look at this program, its surroundings and the model.

        Raises:
            DataError: If the model's file cannot be read.
        """
        commit, modified = _checkout(Path(__file__).resolve().parents[2])
        return cls(
            version=metadata.version(DISTRIBUTION),
            commit=commit,
            modified=modified,
            seeds=tuple(seeds),
            options=dict(options),
            model=None if model is None else str(model),
            model_sha256=None if model is None else file_sha256(model),
            packages=_package_versions(),
            python=platform.python_version(),
            machine=platform.platform(),
        )

    def to_json(self) -> str:
        """The provenance as a JSON object."""
        return json.dumps(asdict(self), indent=2, ensure_ascii=False)

    def save(self, file: Path) -> None:
        """Write it as JSON.

        Raises:
            DataError: If the file cannot be written.
        """
        write_file(file, f"{self.to_json()}\n".encode())


def file_sha256(file: Path) -> str:
    """The SHA-256 checksum of a file's contents, in hexadecimal digits.

    Raises:
        DataError: If the file cannot be read.
    """
    with told(file, "read"), file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _package_versions() -> dict[str, str]:
    """Installed version of each direct dependency; extras that are not installed are left out."""
    names = {
        re.split(r"[^\w.-]", requirement, maxsplit=1)[0]
        for requirement in metadata.requires(DISTRIBUTION) or []
    }
    return {name: metadata.version(name) for name in sorted(names) if _is_installed(name)}


def _is_installed(name: str) -> bool:
    try:
        metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return False
    return True


def _checkout(root: Path) -> tuple[str | None, bool | None]:
    """Commit of a git checkout, and whether it differs from it; (None, None) where there is none."""
    if not (root / ".git").exists():
        return None, None
    commit, status = (
        _git(root, "rev-parse", "HEAD"),
        _git(root, "status", "--porcelain", "--untracked-files=no"),
    )
    return commit, None if status is None else status != ""


def _git(root: Path, *arguments: str) -> str | None:
    """What git prints, without the end of its line; None if git is missing or fails."""
    try:
        run = subprocess.run(
            ["git", "-C", str(root), *arguments], capture_output=True, text=True, check=True, timeout=10
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return run.stdout.strip()
