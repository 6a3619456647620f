"""How old the pose is that the page shows: where the handle is in every picture, against the physics."""

from dataclasses import dataclass
from itertools import pairwise
from time import time
from typing import Any

import numpy as np

from cobot_lfd.app.studio.stage import Stage
from cobot_lfd.arrays import Array

# For every picture: when the page gave it to the graphics, when they had finished it (a fence tells), and
# where the handle is in it.
_WATCH = """
() => {
  const { scene, canvas, nodeRefFromName } = window.__viserMutable;
  const gl = canvas.getContext('webgl2') ?? canvas.querySelector('canvas').getContext('webgl2');
  window.pictures = [];
  const now = () => (performance.timeOrigin + performance.now()) / 1000;
  scene.onAfterRender = () => {
    const given = now();
    const { x, y, z } = nodeRefFromName['/handle'].position;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      if (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) {
        setTimeout(look, 2);
        return;
      }
      gl.deleteSync(fence);
      window.pictures.push([given, now(), x, y, z]);
    };
    look();
  };
}
"""
_STOP = "() => { window.__viserMutable.scene.onAfterRender = () => {}; return window.pictures; }"
_MOVES = 0.03  # [m/s]; of a slower tool, nobody can tell how old its pose is
_SAME = 1e-6  # [m] between the pose in a picture and the one that was sent


@dataclass(frozen=True, slots=True)
class Ages:
    """Ages of the poses that were shown while the tool moved.

    Attributes:
        given: When the page gave their pictures to the graphics [s], shape (M,).
        finished: When the graphics had finished them [s], shape (M,).
        replaced: When the next ones were finished, until which they were to be seen [s], shape (M,).
    """

    given: Array
    finished: Array
    replaced: Array

    def __str__(self) -> str:
        """Medians and 95th percentiles in milliseconds."""
        if not len(self.given):
            return "of unknown age: no picture shows a moving tool"
        moments = {
            "when the page draws it": self.given,
            "when the graphics have finished": self.finished,
            "when the next one follows": self.replaced,
        }
        told = (
            f"{1000 * np.median(ages):.0f} ms (95 %: {1000 * np.percentile(ages, 95):.0f}) {moment}"
            for moment, ages in moments.items()
        )
        return f"{', '.join(told)}; {len(self.given)} pictures"


class Places:
    """Notes when the tool was where, as often as the page is told."""

    def __init__(self, stage: Stage) -> None:
        self._notes: list[tuple[float, ...]] = []
        audience: Any = stage.audience
        tell = audience.moved

        def moved(client: Any, stage: Stage) -> None:
            self._notes.append((time(), *stage.shown_tool.tolist()))
            tell(client, stage)

        audience.moved = moved

    @property
    def history(self) -> Array:
        """Time [s] and place [m], shape (M, 4)."""
        return np.array(self._notes)


def begin_watching(page: Any) -> None:
    """Begin to note what the page draws."""
    page.evaluate(_WATCH)


def end_watching(page: Any) -> Array:
    """When each picture was given to the graphics and finished [s], where its handle is [m], shape (N, 5)."""
    return np.array(page.evaluate(_STOP), dtype=np.float64).reshape(-1, 5)


def ages(pictures: Array, history: Array) -> Ages:
    """How old the pose in each picture was, of a tool on its way.

    Args:
        pictures: When each was given to the graphics and finished [s], its handle's place [m], shape (N, 5).
        history: When the tool was where [s], [m], shape (M, 4).
    """
    speeds = np.linalg.norm(np.diff(history[:, 1:], axis=0), axis=1) / np.diff(history[:, 0])
    moves = np.minimum(speeds[:-1], speeds[1:]) > _MOVES
    on_its_way = history[1:-1][moves]
    found = []
    for (given, finished, *place), (_, following, *_) in pairwise(pictures):
        away = np.abs(on_its_way[:, 1:] - place).max(axis=1)
        [same] = np.nonzero((away < _SAME) & (on_its_way[:, 0] <= given))
        if len(same):
            found.append(np.array([given, finished, following]) - on_its_way[same[-1], 0])
    return Ages(*np.array(found).reshape(-1, 3).T)
