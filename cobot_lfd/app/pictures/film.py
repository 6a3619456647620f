"""A video of an episode, from where a visitor would stand."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from cobot_lfd.app.execute import Observer
from cobot_lfd.app.pictures.video import VideoWriter
from scenes import CameraDescription, World

_FRAMES_PER_SECOND = 20
_VISITOR = CameraDescription(
    position=(1.45, -0.95, 0.85),
    target=(0.33, 0.0, 0.26),
    up=(0.0, 0.0, 1.0),
    field_of_view_deg=36.0,
    width=640,
    height=480,
)


class Film:
    """Films a world at an even rate; called after every step of the simulation."""

    def __init__(self, world: World, writer: VideoWriter) -> None:
        self._world = world
        self._writer = writer
        self._next = world.time
        self()

    def __call__(self) -> None:
        """Take a frame where one is due."""
        if self._world.time >= self._next:
            self._writer.write(self._world.take_picture(camera=_VISITOR))
            self._next += 1.0 / self._writer.fps


@contextmanager
def filming(file: Path) -> Iterator[Callable[[World], Observer]]:
    """Gives what starts to film a world; the video is there when the block ends well.

    Raises:
        CobotError: If the file cannot be written.
    """
    with VideoWriter(file, fps=_FRAMES_PER_SECOND) as writer:
        yield lambda world: Film(world, writer)
