"""Compose the README's picture from the files that ``make demo`` leaves behind.

Usage: python tools/readme_picture.py demo docs/pick_and_place.jpg
"""

import sys
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
HEIGHT = 420  # [px]
SHARE_OF_THE_VIDEO = 0.5  # the arm carries the part


def still(video: Path, share: float) -> Picture:
    """The picture after a share of a video."""
    capture = cv2.VideoCapture(str(video))
    pictures: list[Picture] = []
    while (frame := capture.read())[0]:
        pictures.append(np.asarray(frame[1], dtype=np.uint8))
    if not pictures:
        raise SystemExit(f"{video} holds no picture; run 'make demo' first.")
    return pictures[round(share * (len(pictures) - 1))]


def scaled(picture: Picture) -> Picture:
    """The picture at the common height."""
    width = round(picture.shape[1] * HEIGHT / picture.shape[0])
    return np.asarray(cv2.resize(picture, (width, HEIGHT), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def main(folder: Path, file: Path) -> None:
    """Put what the camera saw, the generated path and the arm side by side."""
    pictures = [cv2.imread(str(folder / name)) for name in ("camera.png", "path.png")]
    if any(picture is None for picture in pictures):
        raise SystemExit(f"{folder} lacks camera.png or path.png; run 'make demo' first.")
    shown = [*pictures, still(folder / "run.webm", SHARE_OF_THE_VIDEO)]
    row = np.hstack([scaled(np.asarray(picture, dtype=np.uint8)) for picture in shown])
    file.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(file), row, [cv2.IMWRITE_JPEG_QUALITY, 88])
    print(file)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
