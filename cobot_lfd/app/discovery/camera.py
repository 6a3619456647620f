"""The camera that took the pictures of demonstrations."""

from collections.abc import Sequence

import numpy as np

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.camera import Camera
from cobot_lfd.errors import DataError, DescriptionError
from scenes import load_scene


def camera_of(episodes: Sequence[RecordedEpisode]) -> Camera:
    """The one camera that took all pictures.

    Recordings tell it; for one that does not, the camera of its scene is taken.

    Raises:
        DataError: If the cameras differ, or nothing tells which it was.
    """
    cameras = [episode.camera or _of_scene(episode) for episode in episodes]
    for episode, camera in zip(episodes, cameras, strict=True):
        if not _same(camera, cameras[0]):
            raise DataError(
                f"the demonstration of seed {episode.seed} was seen by another camera than that of seed "
                f"{episodes[0].seed}; find frames in demonstrations of one camera."
            )
    return cameras[0]


def _of_scene(episode: RecordedEpisode) -> Camera:
    try:
        return load_scene(episode.scene).camera.camera
    except DescriptionError as error:
        raise DataError(
            f"the demonstration of seed {episode.seed} does not tell its camera, and neither does its scene: "
            f"{error}"
        ) from error


def _same(a: Camera, b: Camera) -> bool:
    values = [
        (a.matrix, b.matrix),
        (a.distortion, b.distortion),
        (a.world_from_camera.position, b.world_from_camera.position),
        (a.world_from_camera.rotation, b.world_from_camera.rotation),
    ]
    return (a.width, a.height) == (b.width, b.height) and all(np.allclose(x, y) for x, y in values)
