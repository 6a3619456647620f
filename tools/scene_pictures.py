"""A small picture of each scene: what its camera sees, with the frames that perception finds in it."""

import sys
from pathlib import Path

import tyro

from cobot_lfd.app.perceive import perceive
from cobot_lfd.app.pictures.draw import draw_detections, encode_small
from scenes import World, load_scene, object_models, scene_names

WIDTH = 400  # [px]


def main(*, out: Path, scene: tuple[str, ...] = scene_names(), seed: int = 3) -> int:
    """Draw the pictures.

    Args:
        out: Folder for the pictures, <scene>.webp.
        scene: Names of the scenes.
        seed: Decides where the objects stand.
    """
    out.mkdir(parents=True, exist_ok=True)
    for name in scene:
        description = load_scene(name)
        with World(description, seed) as world:
            view = perceive(world)
        camera = description.camera.camera
        seen = [item for item in view.detections if description.objects[item.name].seen]
        drawn = draw_detections(view.picture, camera, seen, models=object_models(description))
        file = out / f"{name}.webp"
        file.write_bytes(encode_small(drawn, width=WIDTH))
        print(file)
    return 0


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
