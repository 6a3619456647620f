"""A person's hand in the simulator's own window: mouse and keys there move the guided hand.

The window has a mouse picking of its own, which ties the body under the pointer to it by a constraint. It is
switched off, because nobody learns its force: what is recorded would move without a cause. The mouse pulls
through the same spring as in the browser instead.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from cobot_lfd.app.guided_hand import GuidedHand
from cobot_lfd.app.hand import HandAction
from cobot_lfd.app.studio.pointer import Grab
from cobot_lfd.arrays import Array
from robots import Arm, ArmState

_FAR = 10.0  # [m] along the ray through the pointer
_TURN = np.deg2rad(10.0)
_POLL_EVERY = 5  # ticks between two looks at mouse and keys
_MOVE, _BUTTON, _LEFT = 1, 2, 0  # kinds of mouse events, and the button, as the window numbers them
_DOWN, _UP = 3, 4  # states of a button: pressed just now, released just now


def prepare_window(client: Any, target: Array) -> None:
    """Show the picture alone, seen from in front of the table, with the keys and the mouse left to the hand.

    Args:
        client: The simulation with the window.
        target: What is in its middle [m], shape (3,).
    """
    off = (
        client.COV_ENABLE_GUI,
        client.COV_ENABLE_MOUSE_PICKING,
        client.COV_ENABLE_KEYBOARD_SHORTCUTS,
        client.COV_ENABLE_RGB_BUFFER_PREVIEW,
        client.COV_ENABLE_DEPTH_BUFFER_PREVIEW,
        client.COV_ENABLE_SEGMENTATION_MARK_PREVIEW,
        client.COV_ENABLE_SHADOWS,
    )
    for flag in off:
        client.configureDebugVisualizer(flag, 0)
    client.resetDebugVisualizerCamera(1.2, 60.0, -35.0, target.tolist())


class WindowHand:
    """Looks at the window's mouse and keys, and lets a guided hand do what they say.

    Attributes:
        hand: The guided hand.
    """

    def __init__(self, client: Any, arm: Arm, hand: GuidedHand, align: Callable[[], None]) -> None:
        self.hand = hand
        self._client, self._arm = client, arm
        self._grab: Grab | None = None
        self._tick = 0
        self._done = False
        client.getKeyboardEvents()  # what was pressed before is not meant for this demonstration
        client.getMouseEvents()
        self._keys: dict[int, Callable[[], None]] = {
            ord("g"): hand.close_or_open,
            ord("s"): hand.lower,
            ord("w"): hand.lift,
            ord("q"): lambda: hand.turn(_TURN),
            ord("e"): lambda: hand.turn(-_TURN),
            ord("a"): align,
            ord("p"): self._switch_guide,
            client.B3G_RETURN: self._finish,
        }

    def act(self, state: ArmState) -> HandAction | None:
        """What the hand does in the next tick; None when Return was pressed."""
        if self._tick % _POLL_EVERY == 0:
            self._look_at_keys()
            self._look_at_mouse(state)
        self._tick += 1
        return None if self._done else self.hand.act(state)

    def _look_at_keys(self) -> None:
        for key, key_state in self._client.getKeyboardEvents().items():
            if key_state & self._client.KEY_WAS_TRIGGERED and key in self._keys:
                self._keys[key]()

    def _look_at_mouse(self, state: ArmState) -> None:
        for kind, x, y, button, button_state in self._client.getMouseEvents():
            if kind == _BUTTON and button == _LEFT and button_state == _DOWN:
                self._take_hold(x, y, state)
            elif kind == _BUTTON and button == _LEFT and button_state == _UP:
                self._grab = None
                self.hand.let_go()
            if self._grab is not None:
                camera, through = self._ray(x, y)
                self.hand.reach(self._on_screen_plane(self._grab, camera, through))

    def _take_hold(self, x: float, y: float, state: ArmState) -> None:
        """Begin a drag, where the pointer is on the arm."""
        camera, through = self._ray(x, y)
        body, _, _, place, _ = self._client.rayTest(camera.tolist(), through.tolist())[0]
        if body == self._arm.body.id:
            self._grab = Grab(0, place, state.world_from_tool.position)

    def _on_screen_plane(self, grab: Grab, camera: Array, through: Array) -> Array:
        """Where the pointer wants the tool: on the plane that faces the camera, or level with the guide."""
        forward = np.array(self._client.getDebugVisualizerCamera()[5])
        ray = through - camera
        depth = (grab.grabbed - camera) @ forward / (ray @ forward)
        return grab.goal(camera, camera + depth * ray, guide=self.hand.guide)

    def _ray(self, x: float, y: float) -> tuple[Array, Array]:
        """The camera's centre and a far point on the ray through a pixel [m]."""
        info = self._client.getDebugVisualizerCamera()
        width, height = info[0], info[1]
        forward, right, up = (np.array(info[i]) for i in (5, 6, 7))
        camera = np.array(info[11]) - info[10] * forward
        # The window's projection matrix tells its field of view, column by column.
        across, upward = 1.0 / info[3][0], 1.0 / info[3][5]
        u, v = 2.0 * (x + 0.5) / width - 1.0, 1.0 - 2.0 * (y + 0.5) / height
        right, up = right / np.linalg.norm(right), up / np.linalg.norm(up)
        ray = forward / np.linalg.norm(forward) + u * across * right + v * upward * up
        return camera, camera + _FAR * ray

    def _switch_guide(self) -> None:
        self.hand.guide = not self.hand.guide

    def _finish(self) -> None:
        self._done = True
