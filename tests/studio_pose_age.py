"""How old the pose is that the page shows: the handle's height in the picture, against the physics'."""

from dataclasses import dataclass
from time import time
from typing import Any

import numpy as np

from cobot_lfd.app.studio.stage import Stage
from cobot_lfd.arrays import Array

# After every picture that the page has drawn: when, and the mean row of the pixels that the handle colours.
_WATCH = """
() => {
  const size = (canvas) => canvas.width * canvas.height;
  const shown = [...document.querySelectorAll('canvas')].sort((a, b) => size(b) - size(a))[0];
  const copy = document.createElement('canvas');
  copy.width = shown.width / 2; copy.height = shown.height / 2;
  const context = copy.getContext('2d', { willReadFrequently: true });
  window.rows = [];
  const look = () => {
    const now = (performance.timeOrigin + performance.now()) / 1000;
    context.drawImage(shown, 0, 0, copy.width, copy.height);
    const pixels = context.getImageData(0, 0, copy.width, copy.height).data;
    let sum = 0, count = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      const blue = pixels[i + 2];
      if (pixels[i] - blue < 50 || pixels[i + 1] - blue < 18) continue;
      sum += Math.floor(i / 4 / copy.width);
      count += 1;
    }
    if (count > 10) window.rows.push([now, sum / count]);
    window.watching = requestAnimationFrame(look);
  };
  window.watching = requestAnimationFrame(look);
}
"""
_FEWEST = 8  # pictures, of which three at each end are of a tool at rest
_STOP = "() => { cancelAnimationFrame(window.watching); return window.rows; }"


@dataclass(frozen=True, slots=True)
class Ages:
    """Ages of the poses that were shown while the tool moved.

    Attributes:
        median: [s]; not a number where the page drew too few pictures.
        worst: [s].
        n_pictures: In how many pictures the tool was on its way.
    """

    median: float
    worst: float
    n_pictures: int


class Heights:
    """Notes when the tool was at which height, as often as the page is told."""

    def __init__(self, stage: Stage) -> None:
        self._notes: list[tuple[float, float]] = []
        audience: Any = stage.audience
        tell = audience.moved

        def moved(client: Any, stage: Stage) -> None:
            self._notes.append((time(), float(stage.shown_tool[2])))
            tell(client, stage)

        audience.moved = moved

    @property
    def history(self) -> Array:
        """Time [s] and height [m], shape (M, 2)."""
        return np.array(self._notes)


def begin_watching(page: Any) -> None:
    """Begin to look at what the page draws."""
    page.evaluate(_WATCH)


def ages(page: Any, heights: Heights) -> Ages:
    """What was seen since then, of a tool that went up or down once, and rested before and after.

    The rows of the two rests tell which row belongs to which height; between them, every picture is matched
    to the moment at which the tool was where the picture shows it.
    """
    rows, history = np.array(page.evaluate(_STOP)), heights.history
    if len(rows) < _FEWEST:
        return Ages(np.nan, np.nan, len(rows))
    first, last = np.median(rows[:3, 1]), np.median(rows[-3:, 1])
    start, end = (float(np.interp(rows[i, 0], *history.T)) for i in (0, -1))
    shown = start + (rows[:, 1] - first) / (last - first) * (end - start)
    share = (shown - start) / (end - start)
    moving = (share > 0.15) & (share < 0.85)
    passed = (history[:, 1] - start) / (end - start)
    inside = (history[:, 0] >= rows[0, 0]) & (passed > 0.02) & (passed < 0.98)
    if not moving.any() or not inside.any():
        return Ages(np.nan, np.nan, 0)
    when = np.interp(share[moving], passed[inside], history[inside, 0])
    age = rows[moving, 0] - when
    return Ages(float(np.median(age)), float(age.max()), len(age))
