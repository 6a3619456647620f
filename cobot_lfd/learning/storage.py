"""Models on disk: a versioned zip of plain arrays and one JSON text, nothing of which is executed."""

import json
import os
import zipfile
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

from cobot_lfd.arrays import Array
from cobot_lfd.errors import ModelError

FORMAT = "cobot_lfd model"
VERSION = 2


def save(path: Path, value: object) -> None:
    """Write a value made of dataclasses, enums, arrays, tuples, mappings and plain values.

    The file appears whole or not at all: it is written beside its place and then renamed.
    """
    arrays: dict[str, Any] = {}
    tree = _describe(value, arrays)
    header = json.dumps({"format": FORMAT, "version": VERSION, "model": tree})
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    with partial.open("wb") as file:
        np.savez_compressed(file, header=np.array(header), **arrays)
        file.flush()
        os.fsync(file.fileno())
    partial.replace(path)


def load(path: Path, classes: Mapping[str, type]) -> object:
    """Read such a value back; only the given classes are made.

    Raises:
        ModelError: If the file is missing, damaged, no model, or of a version that cannot be read.
    """
    if not path.is_file():
        raise ModelError(f"there is no model file {path}; fit one first.")
    try:
        with path.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        header = json.loads(str(arrays.pop("header")))
        known = isinstance(header, dict) and header.get("format") == FORMAT
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zipfile.LargeZipFile) as error:
        raise ModelError(f"{path} is damaged or no model file; fit the model again.") from error
    if not known:
        raise ModelError(f"{path} is no model file of cobot_lfd.")
    if header.get("version") != VERSION:
        raise ModelError(
            f"{path} is a model of version {header.get('version')}; this program reads version {VERSION}. "
            "Fit the model again from its demonstrations."
        )
    try:
        return _make(header["model"], arrays, classes)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        raise ModelError(f"{path} is damaged: {error}; fit the model again.") from error


def _describe(value: object, arrays: dict[str, Array]) -> Any:
    """The value as JSON; its arrays are put aside and named."""
    if isinstance(value, np.ndarray):
        name = f"a{len(arrays)}"
        arrays[name] = value
        return {"array": name}
    if isinstance(value, Enum):
        return {"enum": type(value).__name__, "value": value.value}
    if is_dataclass(value):
        content = {f.name: _describe(getattr(value, f.name), arrays) for f in fields(value)}
        return {"class": type(value).__name__, "fields": content}
    if isinstance(value, Mapping):
        return {"mapping": [[_describe(k, arrays), _describe(v, arrays)] for k, v in value.items()]}
    if isinstance(value, tuple):
        return {"tuple": [_describe(item, arrays) for item in value]}
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise TypeError(f"a model cannot hold a {type(value).__name__}.")


def _make(tree: Any, arrays: Mapping[str, Array], classes: Mapping[str, type]) -> Any:
    """The value that was described."""
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        array = arrays[tree["array"]]
        array.setflags(write=False)
        return array
    if "enum" in tree:
        return classes[tree["enum"]](tree["value"])
    if "mapping" in tree:
        return {_make(k, arrays, classes): _make(v, arrays, classes) for k, v in tree["mapping"]}
    if "tuple" in tree:
        return tuple(_make(item, arrays, classes) for item in tree["tuple"])
    content = {name: _make(item, arrays, classes) for name, item in tree["fields"].items()}
    return classes[tree["class"]](**content)
