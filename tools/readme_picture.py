"""Compose the README's picture from the files that ``cobot-lfd demo`` leaves behind.

Usage: python tools/readme_picture.py demo docs/ball_in_hole.jpg
"""

import sys
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
WIDTH = 1280  # [px]; a page shows about 900 of them, at which the plot's text is still read
SHARE_OF_THE_VIDEO = 0.5  # the arm carries the part
QUALITY = 85  # of the JPEG, in percent


def still(video: Path, share: float) -> Picture:
    """The picture after a share of a video."""
    capture = cv2.VideoCapture(str(video))
    pictures: list[Picture] = []
    while (frame := capture.read())[0]:
        pictures.append(np.asarray(frame[1], dtype=np.uint8))
    if not pictures:
        raise SystemExit(f"{video} holds no picture; run 'cobot-lfd demo' first.")
    return pictures[round(share * (len(pictures) - 1))]


def scaled(picture: Picture, width: int) -> Picture:
    """The picture at a width."""
    height = round(picture.shape[0] * width / picture.shape[1])
    return np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def main(folder: Path, file: Path) -> None:
    """What the camera saw beside the arm at work, and below them what was shown and what was learnt."""
    pictures = [cv2.imread(str(folder / name)) for name in ("camera.png", "path.png")]
    if any(picture is None for picture in pictures):
        raise SystemExit(f"{folder} lacks camera.png or path.png; run 'cobot-lfd demo' first.")
    camera, plot = (np.asarray(picture, dtype=np.uint8) for picture in pictures)
    arm = still(folder / "run.webm", SHARE_OF_THE_VIDEO)
    seen, done = scaled(camera, WIDTH // 2), scaled(arm, WIDTH // 2)
    height = min(len(seen), len(done))
    file.parent.mkdir(parents=True, exist_ok=True)
    rows = np.vstack([np.hstack([seen[:height], done[:height]]), scaled(plot, WIDTH)])
    cv2.imwrite(str(file), rows, [cv2.IMWRITE_JPEG_QUALITY, QUALITY] if file.suffix == ".jpg" else [])
    print(file)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
