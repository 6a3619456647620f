"""Videos that a browser plays: VP8 in a WebM file."""

import secrets
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

from cobot_lfd.app.disk import move_into_place, sync_file, told
from cobot_lfd.errors import CobotError
from cobot_lfd.quiet import quiet_output

CODEC = "VP80"
STDERR = 2
"""Where the encoder prints notes, below Python, even when all is well; they are kept off the console."""


class VideoWriter:
    """Writes a video in a ``with`` statement; the file gets its name when the block ends well.

    If the block ends with an error, no file is left.

    Attributes:
        path: The video's file, ending in ``.webm``.
        fps: Frames per second.
    """

    def __init__(self, path: Path, *, fps: float = 30.0) -> None:
        """Prepare a video; nothing is written before the first frame.

        Args:
            path: The video's file, ending in ``.webm``; one that is there is replaced at the end.
            fps: Frames per second.

        Raises:
            CobotError: If the name has another ending or its folder is missing.
            ValueError: If ``fps`` is not positive.
        """
        if path.suffix.lower() != ".webm":
            raise CobotError(f"cannot write {path}: a video's name must end in .webm.")
        if not path.parent.is_dir():
            raise CobotError(f"cannot write {path}: there is no folder {path.parent}. Make it first.")
        if not fps > 0:
            raise ValueError(f"fps is {fps}; it must be positive.")
        self.path = path
        self.fps = fps
        self._temporary = path.parent / f".{secrets.token_hex(8)}.webm"
        self._encoder: cv2.VideoWriter | None = None
        self._size = (0, 0)
        self._n_frames = 0

    def write(self, frame: NDArray[np.uint8]) -> None:
        """Add a frame, RGB uint8, shape (H, W, 3); an odd last row or column is left out, as VP8 demands.

        Raises:
            CobotError: If the video cannot be written.
            ValueError: If the frame is no picture, or has another size than those before.
        """
        if frame.dtype != np.uint8 or frame.ndim != 3 or frame.shape[2] != 3:
            raise ValueError(
                f"frame has shape {frame.shape} and type {frame.dtype}; it must be (H, W, 3) of uint8."
            )
        height, width = frame.shape[:2]
        if self._encoder is None:
            self._size = (width, height)
            self._encoder = self._open()
        if (width, height) != self._size:
            raise ValueError(
                f"frame {self._n_frames} is {width} x {height} px; those before are "
                f"{self._size[0]} x {self._size[1]} px."
            )
        with quiet_output(STDERR):
            self._encoder.write(np.ascontiguousarray(frame[..., ::-1]))
        self._n_frames += 1

    def __enter__(self) -> Self:
        """The writer itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Finish the video and give the file its name, or remove it if the block failed."""
        try:
            if self._encoder is not None:
                with quiet_output(STDERR):
                    self._encoder.release()
            if error is None:
                self._keep()
        finally:
            with suppress(OSError):
                self._temporary.unlink(missing_ok=True)

    def _open(self) -> cv2.VideoWriter:
        with quiet_output(STDERR):
            encoder = cv2.VideoWriter(
                str(self._temporary), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*CODEC), self.fps, self._size
            )
        if not encoder.isOpened():
            raise CobotError(
                f"cannot write {self.path}: the video encoder does not start. Check that you may write to "
                f"{self.path.parent} and that OpenCV is the opencv-python-headless of this environment."
            )
        return encoder

    def _keep(self) -> None:
        if self._n_frames == 0:
            raise CobotError(f"cannot write {self.path}: no frame was given for the video.")
        if _count_frames(self._temporary) != self._n_frames:
            raise CobotError(
                f"cannot write {self.path}: it came out incomplete. Check that the disk is not full."
            )
        with told(self.path, "write"):
            sync_file(self._temporary)
            move_into_place(self._temporary, self.path)


def _count_frames(file: Path) -> int:
    """Number of frames according to the file's own index, which is written last."""
    with quiet_output(STDERR):
        capture = cv2.VideoCapture(str(file), cv2.CAP_FFMPEG)
        try:
            return round(capture.get(cv2.CAP_PROP_FRAME_COUNT))
        finally:
            capture.release()
