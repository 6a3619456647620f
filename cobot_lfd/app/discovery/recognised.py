"""Demonstrations with the frames of a model, recognised in their pictures where the model does that."""

from collections.abc import Sequence

from cobot_lfd.app.demonstrations.episode import RecordedEpisode
from cobot_lfd.app.discovery.camera import camera_of
from cobot_lfd.demonstration import Demonstration
from cobot_lfd.detection import Detection
from cobot_lfd.errors import DataError
from cobot_lfd.method import PathModel
from cobot_lfd.recognition import Recognition
from perception.discovery import recognise_frames


def demonstrations_of(model: PathModel, episodes: Sequence[RecordedEpisode]) -> list[Demonstration]:
    """Each recording's path with the frames of a model.

    Raises:
        DataError: If a recording has no picture, or a frame cannot be recognised in it.
    """
    if model.recognition is None:
        return [episode.demonstration() for episode in episodes]
    return [_recognised(episode, model.recognition) for episode in episodes]


def _recognised(episode: RecordedEpisode, recognition: Recognition) -> Demonstration:
    camera = camera_of([episode])
    try:
        found = recognise_frames(episode.picture, camera, recognition)
    except ValueError as error:
        raise DataError(f"the demonstration of seed {episode.seed}: {error}") from error
    frames = {}
    for item in found:
        if not isinstance(item, Detection):
            raise DataError(
                f"the demonstration of seed {episode.seed} does not show '{item.name}': {item.reason}"
            )
        frames[item.name] = item.frame
    return Demonstration(
        episode.tool_positions[episode.carrying, :2], frames, episode.times[episode.carrying]
    )
