"""Variants of a scene: the same task with more in the way, or with its objects farther out."""

import copy
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cobot_lfd.description_file import read_toml
from cobot_lfd.errors import DescriptionError

_FOLDER = Path(__file__).parent / "variants"
_FULL_CIRCLE = 180.0  # [degrees] in either direction
_AXES = ("x", "y", "angle_deg")


def variant_names() -> tuple[str, ...]:
    """Names of the variants that every scene has, in alphabetical order."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


def split_variant(name: str) -> tuple[str, str | None]:
    """The name of a scene and that of its variant: ``sorting@wide`` is the variant ``wide`` of ``sorting``.

    Raises:
        DescriptionError: If there is no such variant.
    """
    scene, at, variant = name.partition("@")
    if not at:
        return scene, None
    if variant not in variant_names():
        raise DescriptionError(f"no variant named '{variant}'; choose one of: {', '.join(variant_names())}.")
    return scene, variant


def apply_variant(content: Mapping[str, Any], variant: str | None) -> dict[str, Any]:
    """What a scene's file says, changed to a variant.

    A variant's own file says what it changes in all scenes; the table ``variants.<name>`` of a scene's file
    adds to that. The number ``widen`` stretches the ranges of all places about their middles.

    Args:
        content: What the scene's file says.
        variant: Name of the variant; None for the scene as it is.
    """
    values: dict[str, Any] = copy.deepcopy(dict(content))
    own = values.pop("variants", {})
    if variant is None:
        return values
    patch = _merged(read_toml(_FOLDER / f"{variant}.toml"), own.get(variant, {}))
    widen = patch.pop("widen", 1.0)
    for item in values.get("objects", {}).values():
        item["place"] = _widened(item.get("place", {}), widen)
    return _merged(values, patch)


def _merged(values: Mapping[str, Any], patch: Mapping[str, Any]) -> dict[str, Any]:
    """The values with those of the patch in their place, table by table."""
    merged = dict(values)
    for key, value in patch.items():
        both_tables = isinstance(value, Mapping) and isinstance(merged.get(key), Mapping)
        merged[key] = _merged(merged[key], value) if both_tables else value
    return merged


def _widened(place: Mapping[str, Any], factor: float) -> dict[str, Any]:
    widened = dict(place)
    for axis in _AXES:
        if isinstance(place.get(axis), list):
            low, high = place[axis]
            middle, half = 0.5 * (low + high), 0.5 * factor * (high - low)
            if axis == "angle_deg":
                half = min(half, _FULL_CIRCLE)
            widened[axis] = [middle - half, middle + half]
    return widened
