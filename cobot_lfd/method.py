"""What a learning method must offer to be evaluated on this bench: ``fit`` and ``reproduce``."""

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from cobot_lfd.arrays import Array
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.frame import Frame, FrameKind
from cobot_lfd.learning.path import GeneratedPath
from cobot_lfd.recognition import Recognition


@runtime_checkable
class Reproducer(Protocol):
    """What a method has learnt: it leads through new scenes."""

    def reproduce(self, frames: Mapping[str, Frame], /) -> GeneratedPath | Array:
        """The path for the frames of a new scene.

        Args:
            frames: Name to frame, for all objects that the demonstrations had.

        Returns:
            A generated path, or its positions alone [m], shape (T, 2), in the order of time.
        """
        ...


@runtime_checkable
class Method(Protocol):
    """A learning method; a class whose ``fit`` is a class method is one, too."""

    def fit(self, demonstrations: Sequence[Demonstration], /) -> Reproducer:
        """Learn from demonstrations."""
        ...


class PathModel(Protocol):
    """What an episode needs to know of a learnt model."""

    @property
    def method(self) -> str:
        """Name of the method that it was fitted by."""
        ...

    @property
    def frame_kinds(self) -> Mapping[str, FrameKind]:
        """The frames that it needs, and whether the path depends on the direction of each."""
        ...

    @property
    def recognition(self) -> Recognition | None:
        """How its frames are recognised in a picture; None where they are the scene's objects."""
        ...

    def reproduce(self, frames: Mapping[str, Frame], /) -> GeneratedPath:
        """The path for the frames of a new scene.

        Raises:
            ModelError: If there is no path for these frames.
        """
        ...
