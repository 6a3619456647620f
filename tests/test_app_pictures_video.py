"""Videos come out whole, in their colours, or not at all."""

import resource
from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose

from cobot_lfd.app.pictures.draw import Picture
from cobot_lfd.app.pictures.video import VideoWriter
from cobot_lfd.errors import CobotError

ORANGE = (230, 140, 20)


def frame(colour: tuple[int, int, int] = ORANGE, *, width: int = 64, height: int = 48) -> Picture:
    return np.full((height, width, 3), colour, dtype=np.uint8)


def write_all(file: Path, frames: Iterable[Picture]) -> None:
    """Write a whole video."""
    with VideoWriter(file) as video:
        for picture in frames:
            video.write(picture)


def read_frames(file: Path) -> list[Picture]:
    """All frames of a video, RGB."""
    capture = cv2.VideoCapture(str(file))
    frames: list[Picture] = []
    while True:
        found, picture = capture.read()
        if not found:
            return frames
        frames.append(np.asarray(picture[..., ::-1], dtype=np.uint8))


def test_frames_come_back_in_order_and_in_their_colours(tmp_path: Path) -> None:
    colours = [ORANGE, (20, 140, 230), (30, 200, 60)] * 10
    with VideoWriter(tmp_path / "run.webm", fps=25) as video:
        for colour in colours:
            video.write(frame(colour))
    frames = read_frames(tmp_path / "run.webm")
    assert len(frames) == len(colours)
    for picture, colour in zip(frames, colours, strict=True):
        assert_allclose(picture.mean(axis=(0, 1)), colour, atol=12)  # lossy, and colour at half resolution


def test_the_video_is_vp8_in_webm_at_the_given_rate(tmp_path: Path) -> None:
    with VideoWriter(tmp_path / "run.webm", fps=25) as video:
        for _ in range(5):
            video.write(frame())
    capture = cv2.VideoCapture(str(tmp_path / "run.webm"))
    assert int(capture.get(cv2.CAP_PROP_FOURCC)).to_bytes(4, "little") == b"VP80"
    assert capture.get(cv2.CAP_PROP_FPS) == 25
    assert b"webm" in (tmp_path / "run.webm").read_bytes()[:64]


def test_nothing_but_the_video_is_left(tmp_path: Path) -> None:
    with VideoWriter(tmp_path / "run.webm") as video:
        video.write(frame())
        assert not (tmp_path / "run.webm").exists()
    assert [path.name for path in tmp_path.iterdir()] == ["run.webm"]


def test_an_error_leaves_the_old_video_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "run.webm").write_bytes(b"the old one")
    with pytest.raises(ValueError, match="is 32 x 48 px"):
        write_all(tmp_path / "run.webm", [frame(), frame(width=32)])
    assert (tmp_path / "run.webm").read_bytes() == b"the old one"
    assert len(list(tmp_path.iterdir())) == 1


def test_writing_a_video_prints_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with VideoWriter(tmp_path / "run.webm") as video:
        video.write(frame())
    assert capfd.readouterr() == ("", "")


def test_a_missing_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(
        CobotError, match=r"cannot write .*run\.webm: there is no folder .*none\. Make it first"
    ):
        VideoWriter(tmp_path / "none" / "run.webm")


def test_another_ending_is_told(tmp_path: Path) -> None:
    with pytest.raises(CobotError, match=r"cannot write .*run\.mp4: a video's name must end in \.webm"):
        VideoWriter(tmp_path / "run.mp4")


def test_a_video_without_frames_is_told(tmp_path: Path) -> None:
    with pytest.raises(CobotError, match="no frame was given"), VideoWriter(tmp_path / "run.webm"):
        pass
    assert not list(tmp_path.iterdir())


def test_frames_of_two_sizes_are_refused(tmp_path: Path) -> None:
    with VideoWriter(tmp_path / "run.webm") as video:
        video.write(frame())
        with pytest.raises(ValueError, match="frame 1 is 32 x 48 px; those before are 64 x 48 px"):
            video.write(frame(width=32))


def test_a_frame_that_is_no_rgb_picture_is_refused(tmp_path: Path) -> None:
    grey = np.zeros((48, 64), dtype=np.uint8)
    with (
        pytest.raises(ValueError, match=r"frame has shape \(48, 64\) and type uint8"),
        VideoWriter(tmp_path / "run.webm") as video,
    ):
        video.write(grey)


def test_a_full_disk_is_told_and_leaves_nothing_behind(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    noise = [rng.integers(0, 256, (240, 320, 3), dtype=np.uint8) for _ in range(20)]
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    try:
        with pytest.raises(CobotError, match=r"it came out incomplete\. Check that the disk is not full"):
            write_all(tmp_path / "run.webm", noise)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert not list(tmp_path.iterdir())
