"""Demonstrations as bytes: the same demonstrations give the same bytes, and nothing in them is executed."""

import io
import json
from collections.abc import Sequence

import numpy as np

from cobot_lfd.demonstration import Demonstration
from cobot_lfd.errors import DataError
from cobot_lfd.frame import Frame


def demonstrations_to_bytes(demonstrations: Sequence[Demonstration]) -> bytes:
    """Planar demonstrations as one JSON text; numbers keep every bit."""
    return json.dumps(
        [
            {
                "path": d.path.tolist(),
                "times": d.times.tolist(),
                "frames": {name: [*f.position.tolist(), f.angle] for name, f in d.frames.items()},
            }
            for d in demonstrations
        ]
    ).encode()


def demonstrations_from_bytes(content: bytes) -> list[Demonstration]:
    """Read them back.

    Raises:
        DataError: If the bytes are no demonstrations.
    """
    try:
        return [
            Demonstration(
                np.array(d["path"]),
                {name: Frame(np.array([x, y]), angle) for name, (x, y, angle) in d["frames"].items()},
                np.array(d["times"]),
            )
            for d in json.load(io.BytesIO(content))
        ]
    except (ValueError, KeyError, TypeError) as error:
        raise DataError(f"the demonstrations kept with the plan are damaged: {error}") from error
