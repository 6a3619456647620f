"""What is compared: a fitted model from a file, or a method with the demonstrations that it learns from."""

import hashlib
import pkgutil
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from cobot_lfd.app.evaluation.demonstration_bytes import demonstrations_from_bytes
from cobot_lfd.baselines.movement_primitive import MovementPrimitive
from cobot_lfd.baselines.straight_line import StraightLine
from cobot_lfd.baselines.world_gmr import WorldGMR
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import CobotError, DataError, ModelError
from cobot_lfd.frame import Frame, FrameKind
from cobot_lfd.learning.model import TaskParameterisedGMM
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.learning.settings import METHODS
from cobot_lfd.method import PathModel, Reproducer

BASELINES: Mapping[str, Any] = MappingProxyType(
    {"line": StraightLine, "world-gmr": WorldGMR, "dmp": MovementPrimitive}
)
"""Methods to compare with, by the names that users give."""


@dataclass(frozen=True, slots=True)
class Contender:
    """What is compared; complete in itself, so that it can be sent to another machine.

    Attributes:
        label: Its name in results and reports.
        method: Name of the method; None for a fitted model.
        content: The model's file, or the demonstrations as bytes.
    """

    label: str
    method: str | None
    content: bytes

    @property
    def sha256(self) -> str:
        """Checksum of the model or the demonstrations."""
        return hashlib.sha256(self.content).hexdigest()


@lru_cache(maxsize=16)
def learnt(contender: Contender, n_demonstrations: int = 0) -> PathModel:
    """The contender's model, fitted or read once in each process.

    Args:
        contender: What is compared.
        n_demonstrations: How many of its demonstrations are used, the first ones; 0 for all.

    Raises:
        CobotError: If the model cannot be read, there is no such method, or it cannot learn from these.
    """
    if contender.method is None:
        if n_demonstrations:
            raise DataError(
                f"{contender.label} is fitted already; the number of demonstrations can be chosen for "
                "methods only: give --method and --demos."
            )
        return _read_model(contender)
    demonstrations = demonstrations_from_bytes(contender.content)
    if n_demonstrations > len(demonstrations):
        raise DataError(
            f"{n_demonstrations} demonstrations are to be used and there are {len(demonstrations)}."
        )
    return fit_method(contender.method, demonstrations[: n_demonstrations or None])


def fit_method(name: str, demonstrations: Sequence[Demonstration]) -> PathModel:
    """Fit a method by its name: ours, a baseline, or ``package.module:Class``.

    Raises:
        CobotError: If there is no such method, or it fails on these demonstrations.
    """
    fit = _find_fit(name)
    try:
        model = fit(demonstrations)
    except CobotError:
        raise
    except Exception as error:  # a method is anybody's code
        raise ModelError(
            f"the method '{name}' cannot learn from these {len(demonstrations)} demonstrations: "
            f"{type(error).__name__}: {error}"
        ) from error
    if isinstance(model, TaskParameterisedGMM):
        return model
    if not isinstance(model, Reproducer):
        raise ModelError(f"fit of '{name}' returned {model!r}; it must return what has reproduce(frames).")
    return _Adapted(name, dict.fromkeys(demonstrations[0].frames, FrameKind.ORIENTED), model)


@dataclass(frozen=True, slots=True, eq=False)
class _Adapted:
    """Anybody's model, its paths checked and its faults told as those of a model."""

    method: str
    frame_kinds: Mapping[str, FrameKind]
    model: Reproducer
    recognition: None = None

    def reproduce(self, frames: Mapping[str, Frame]) -> GeneratedPath:
        """The path for the frames of a new scene; positions alone count as equally spaced and certain."""
        try:
            path = self.model.reproduce(frames)
            return path if isinstance(path, GeneratedPath) else _certain(np.asarray(path, dtype=np.float64))
        except Exception as error:  # a method is anybody's code
            raise ModelError(f"{self.method} raised {type(error).__name__}: {error}") from error


def _certain(positions: Any) -> GeneratedPath:
    if positions.ndim != 2 or positions.shape[1] != 2 or len(positions) < 2:
        raise ValueError(f"reproduce returned an array of shape {positions.shape}; it must be (T, 2).")
    return GeneratedPath(positions, np.zeros((len(positions), 2, 2)), np.linspace(0.0, 1.0, len(positions)))


def _find_fit(name: str) -> Callable[[Sequence[Demonstration]], Any]:
    if name in METHODS:
        return lambda demonstrations: TaskParameterisedGMM.fit(demonstrations, method=name)
    if name in BASELINES:
        fit: Callable[[Sequence[Demonstration]], Any] = BASELINES[name].fit
        return fit
    if ":" not in name:
        raise ModelError(
            f"no method named '{name}'; choose one of: {', '.join([*METHODS, *BASELINES])}, "
            "or name a class as package.module:Class."
        )
    return _foreign_fit(name)


def _foreign_fit(name: str) -> Callable[[Sequence[Demonstration]], Any]:
    """The ``fit`` of somebody's class; where it returns nothing, the object itself is what has learnt."""
    if "" not in sys.path and str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))  # as python -m does: the class may be in a file beside the user
    try:
        found: Any = pkgutil.resolve_name(name)
    except (ImportError, AttributeError, ValueError) as error:
        raise ModelError(f"cannot find the method '{name}': {error}.") from error
    if not hasattr(found, "fit"):
        raise ModelError(f"the method '{name}' has no fit(demonstrations).")

    def fit(demonstrations: Sequence[Demonstration]) -> Any:
        bound = hasattr(found.fit, "__self__")  # a class method, or an object instead of a class
        method = found if bound else found()
        model = method.fit(demonstrations)
        return method if model is None else model

    return fit


def _read_model(contender: Contender) -> PathModel:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / contender.label
        file.write_bytes(contender.content)
        return TaskParameterisedGMM.load(file)
