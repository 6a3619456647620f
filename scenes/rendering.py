"""Pictures of the simulated scene: what its camera would see."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pybullet
from numpy.typing import NDArray
from pybullet_utils.bullet_client import BulletClient

from cobot_lfd.arrays import Array
from cobot_lfd.camera import Camera
from cobot_lfd.errors import CobotError
from cobot_lfd.quiet import quiet_output
from scenes.imperfections import ideal_camera, on_sensor, through_lens
from scenes.prints import Print, draw_prints
from scenes.renderer import Renderer
from scenes.view import CameraDescription, Lens, Light, Sensor

Picture = NDArray[np.uint8]
"""Red, green, blue, shape (height, width, 3)."""

# Where a renderer samples a pixel, measured from the pixel's centre [px]; found by measuring, held by a test.
_GRID_OFFSET = {"tiny": np.array([0.5, -0.5]), "egl": np.zeros(2)}

_LARGEST_EGL = (1024, 768)  # Larger pictures it only magnifies [px].

_NEAR, _FAR = 0.05, 10.0  # What is nearer to or farther from the camera is not drawn [m].


def take_picture(
    client: BulletClient,
    seen: CameraDescription,
    light: Light,
    renderer: Renderer,
    generator: np.random.Generator,
    prints: Sequence[Print] = (),
) -> Picture:
    """What a camera sees now.

    Args:
        client: The simulation.
        seen: The camera.
        light: The light.
        renderer: What draws; it must be the one that the client was made ready for.
        generator: Where the sensor's noise comes from.
        prints: Flat prints that are in the scene.

    Returns:
        Red, green, blue, shape (height, width, 3).

    Raises:
        CobotError: If the picture is larger than the renderer can draw.
    """
    camera = seen.true_camera
    ideal = ideal_camera(camera)
    if renderer == "egl" and (ideal.width > _LARGEST_EGL[0] or ideal.height > _LARGEST_EGL[1]):
        raise CobotError(
            f"the renderer 'egl' draws at most {_LARGEST_EGL[0]} x {_LARGEST_EGL[1]} px; a picture of "
            f"{ideal.width} x {ideal.height} px is needed. Use the renderer 'tiny', or a smaller picture."
        )
    shots = []
    for shift in sample_pattern(seen.samples):
        shot = _shoot(client, ideal, shift + _GRID_OFFSET[renderer], light, renderer)
        width = seen.samples**-0.5
        shots.append(draw_prints(shot.colours, ideal, prints, shot.depth, shift=shift, width=width))
    picture = shots[0] if len(shots) == 1 else np.rint(np.mean(shots, axis=0)).astype(np.uint8)
    if seen.lens == Lens() and seen.sensor == Sensor():
        return picture
    return on_sensor(through_lens(picture, ideal, camera, seen.lens), seen.sensor, generator)


def sample_pattern(n: int) -> Array:
    """Where a pixel is sampled, measured from its centre [px], shape (n, 2).

    No two of the points share a row or a column, so that an edge along either has n steps across a pixel; the
    order of the multiples of the golden ratio spreads them.
    """
    ranks = np.argsort(np.argsort(np.mod(np.arange(n) * (np.sqrt(5) - 1) / 2, 1.0)))
    return (np.column_stack([np.arange(n), ranks]) + 0.5) / n - 0.5


@dataclass(frozen=True, slots=True, eq=False)
class _Shot:
    """What a renderer draws.

    Attributes:
        colours: Red, green, blue, shape (height, width, 3).
        depth: Distance from the camera along its axis [m], shape (height, width).
    """

    colours: Picture
    depth: Array


def _shoot(client: BulletClient, camera: Camera, shift: Array, light: Light, renderer: Renderer) -> _Shot:
    """One ray per pixel, through a point off the pixel's centre by ``shift`` [px]."""
    with quiet_output():
        image = client.getCameraImage(
            camera.width,
            camera.height,
            viewMatrix=view_matrix(camera).T.ravel().tolist(),
            projectionMatrix=projection_matrix(camera, shift).T.ravel().tolist(),
            lightDirection=list(light.direction),
            lightColor=list(light.colour),
            lightDistance=light.distance,
            shadow=int(light.shadow),
            lightAmbientCoeff=light.ambient,
            lightDiffuseCoeff=light.diffuse,
            lightSpecularCoeff=light.specular,
            renderer=pybullet.ER_TINY_RENDERER if renderer == "tiny" else pybullet.ER_BULLET_HARDWARE_OPENGL,
            flags=pybullet.ER_NO_SEGMENTATION_MASK,
        )
    size = (camera.height, camera.width)
    buffer = np.array(image[3], dtype=np.float64).reshape(size)
    return _Shot(
        np.array(image[2], dtype=np.uint8).reshape(*size, 4)[..., :3].copy(),
        _FAR * _NEAR / (_FAR - (_FAR - _NEAR) * buffer),
    )


def view_matrix(camera: Camera) -> Array:
    """From the world to OpenGL's camera (x right, y up, z towards the viewer), shape (4, 4)."""
    camera_from_world = camera.world_from_camera.inverse()
    flip = np.diag([1.0, -1.0, -1.0])
    matrix = np.eye(4)
    matrix[:3, :3] = flip @ camera_from_world.rotation
    matrix[:3, 3] = flip @ camera_from_world.position
    return matrix


def projection_matrix(camera: Camera, shift: Array) -> Array:
    """From OpenGL's camera to its clip space, shape (4, 4).

    Args:
        camera: A camera, whose pixel centres lie at whole numbers; OpenGL has the pixels' edges there.
        shift: Where in a pixel its ray goes through, measured from the pixel's centre [px], shape (2,).
    """
    focal_x, focal_y = camera.matrix[0, 0], camera.matrix[1, 1]
    centre_x, centre_y = camera.matrix[:2, 2] + 0.5 - shift
    return np.array(
        [
            [2 * focal_x / camera.width, 0.0, 1 - 2 * centre_x / camera.width, 0.0],
            [0.0, 2 * focal_y / camera.height, 2 * centre_y / camera.height - 1, 0.0],
            [0.0, 0.0, (_FAR + _NEAR) / (_NEAR - _FAR), 2 * _FAR * _NEAR / (_NEAR - _FAR)],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )
