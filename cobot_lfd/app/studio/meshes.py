"""A mesh as the page needs it: few triangles, and one colour for each of its materials.

A browser without a graphics card draws a hundred thousand triangles five times in a second, and the arm's
makers are generous with them.
"""

from collections import defaultdict
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from cobot_lfd.arrays import Array

_MOST_TRIANGLES = 700  # of a file; fewer show at the arm's outline
_AGGRESSION = 3  # from 0 to 10; the default, 7, is off by centimetres in places
_FEWEST_TRIANGLES = 40  # of a patch
_SMALL = 0.04  # of a mesh's surface; a material that has less is left out: every patch costs the browser time
_ROUND = np.deg2rad(40.0)  # between two triangles up to which their edge is shaded as if it were round
_SHADES = 20  # of a colour; materials that differ by less are one
_WHITE = (1.0, 1.0, 1.0)

Colour = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """A part of a mesh that has one colour.

    Attributes:
        vertices: In the file's units, shape (V, 3).
        faces: Numbers of three vertices each, shape (F, 3).
        colour: Red, green, blue in 0..1.
    """

    vertices: Array
    faces: Any
    colour: Colour


def patches_of(file: Path, colour: Colour) -> tuple[Patch, ...]:
    """The patches of a mesh.

    Args:
        file: Of the mesh.
        colour: That the robot's description gives it. The simulator's camera sees the file's own materials
            where this is white, and so does the page.
    """
    return tuple(
        Patch(patch.vertices, patch.faces, patch.colour if colour == _WHITE else colour)
        for patch in _read(file)
    )


@lru_cache(maxsize=64)
def _read(file: Path) -> tuple[Patch, ...]:
    parts: list[Any] = list(trimesh.load_scene(file).dump())
    alike = _sorted_by_colour(parts)
    n_triangles = sum(len(part.faces) for part in parts)
    patches = []
    for colour, meshes in alike.items():
        mesh: Any = trimesh.util.concatenate(meshes)
        mesh.merge_vertices()
        mesh = _lighter(mesh, round(_MOST_TRIANGLES * len(mesh.faces) / n_triangles))
        shaded = trimesh.graph.smooth_shade(mesh, angle=_ROUND)
        patches.append(Patch(np.array(shaded.vertices), np.array(shaded.faces), colour))
    return tuple(patches)


def _sorted_by_colour(parts: list[Any]) -> dict[Colour, list[Any]]:
    """Parts without materials, by their colours; small ones have the colour that most of the mesh has."""
    area: dict[Colour, float] = defaultdict(float)
    for part in parts:
        area[_material(part.visual)] += part.area
    main = max(area, key=area.__getitem__)
    sorted_parts: dict[Colour, list[Any]] = defaultdict(list)
    for part in parts:
        colour = _material(part.visual)
        is_small = area[colour] < _SMALL * sum(area.values())
        sorted_parts[main if is_small else colour].append(trimesh.Trimesh(part.vertices, part.faces))
    return sorted_parts


def _lighter(mesh: Any, n_triangles: int) -> Any:
    """The mesh with about so many triangles; one that has no more stays as it is."""
    most = max(n_triangles, _FEWEST_TRIANGLES)
    if len(mesh.faces) <= most:
        return mesh
    return mesh.simplify_quadric_decimation(face_count=most, aggression=_AGGRESSION)


def _material(visual: Any) -> Colour:
    """The colour of a material, the mean one where it has a texture."""
    material = getattr(visual, "material", None)
    if material is None:
        return _WHITE
    if getattr(material, "image", None) is None:
        colour = np.array(material.main_color[:3])
    else:
        colour = visual.to_color().vertex_colors[:, :3].mean(axis=0)
    red, green, blue = (_SHADES * colour / 255).round() / _SHADES
    return float(red), float(green), float(blue)
