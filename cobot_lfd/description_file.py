"""Reading TOML files of robots and scenes: a fault is told with file, key, value and what is allowed."""

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from cobot_lfd.errors import DescriptionError


class DescriptionModel(BaseModel):
    """Base of everything a description file may hold: read-only, and without unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


Model = TypeVar("Model", bound=BaseModel)


def read_description(
    file: Path,
    model: type[Model],
    prepare: Callable[[dict[str, Any]], dict[str, Any]] | None = None,
) -> Model:
    """The description in ``file``, validated.

    Args:
        file: A TOML file.
        model: The pydantic model that says which keys and values are allowed.
        prepare: Changes the file's content before it is validated.

    Raises:
        DescriptionError: If the file cannot be read, is no TOML, or holds a key or value that is not allowed.
    """
    content = read_toml(file)
    if prepare is not None:
        content = prepare(content)
    try:
        return model.model_validate(content)
    except ValidationError as error:
        raise DescriptionError("\n".join(f"{file}: {fault}" for fault in _faults(error, content))) from error


def read_toml(file: Path) -> dict[str, Any]:
    """The content of a TOML file.

    Raises:
        DescriptionError: If the file cannot be read or is no TOML.
    """
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise DescriptionError(f"{file}: cannot be read: {error}") from error
    except tomllib.TOMLDecodeError as error:
        raise DescriptionError(f"{file}: is no valid TOML: {error}") from error


def _faults(error: ValidationError, content: Mapping[str, Any]) -> list[str]:
    """One line for each fault: the key, what is wrong and what was given."""
    lines = []
    for fault in error.errors():
        key = _written_key(fault["loc"], content)
        message = fault["msg"].removeprefix("Value error, ")
        if fault["type"] == "missing":
            lines.append(f"{key}: is missing; add it.")
        elif fault["type"] == "extra_forbidden":
            lines.append(f"{key}: is no key that is known here; remove it or correct its spelling.")
        elif fault["type"] == "value_error":
            lines.append(f"{key}: {message}" if key else message)
        else:
            lines.append(f"{key}: {message[0].lower()}{message[1:]}; given: {fault['input']!r}.")
    return lines


def _written_key(location: tuple[int | str, ...], content: Any) -> str:
    """A fault's key as the file writes it.

    Where a key such as ``shape = "box"`` chooses between models, pydantic puts the choice (``box``) into the
    location; it is left out here.
    """
    parts = []
    for part in location:
        is_choice = isinstance(content, Mapping) and part not in content and part in content.values()
        if is_choice:
            continue
        parts.append(str(part))
        if isinstance(content, Mapping):
            content = content.get(part)
        elif isinstance(content, list) and isinstance(part, int) and part < len(content):
            content = content[part]
        else:
            content = None
    return ".".join(parts)
