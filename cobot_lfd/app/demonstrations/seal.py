"""A sealed file: a readable first block with format version and checksum, then the contents it vouches for.

The block fills the first 512 bytes, which HDF5 leaves to applications (its "user block"), so that any HDF5
program opens a sealed HDF5 file as it is. The checksum is looked at before the contents are parsed: damaged
bytes never reach a parser that might do worse than fail.
"""

import hashlib
from collections.abc import Sequence

from cobot_lfd.errors import DataError

BLOCK_SIZE = 512
"""Bytes before the contents; a power of two from 512 on, as HDF5 wants it."""


def seal(contents: bytes, *, title: str, version: int) -> bytes:
    """The bytes of a sealed file.

    Args:
        contents: What is to be kept safe.
        title: What the file is, for people and programs, such as "cobot-lfd episode".
        version: Version of the contents' layout.
    """
    digest = hashlib.sha256(contents).hexdigest()
    return f"{title} version {version}\nsha256 {digest}\n".encode().ljust(BLOCK_SIZE, b"\0") + contents


def check_seal(sealed: bytes, *, title: str, versions: Sequence[int], name: str) -> int:
    """The version of a sealed file, after its contents were checked.

    Args:
        sealed: The bytes of the whole file.
        title: What the file must be.
        versions: The versions that the caller can read.
        name: What the file is called in an error message.

    Raises:
        DataError: If the file is something else, has another version, or was changed or cut since it was
            sealed.
    """
    if not sealed.startswith(f"{title} version ".encode()):
        raise DataError(f"{name} is no {title} file; move it to another folder.")
    given = sealed.split(b"\n", 1)[0].removeprefix(f"{title} version ".encode())
    version = int(given) if given.isdigit() else versions[-1]
    if version not in versions:
        raise DataError(
            f"{name} has version {version} of the {title} format; this program reads version "
            f"{' and '.join(map(str, versions))}. Use the version of the program that wrote it."
        )
    if sealed != seal(sealed[BLOCK_SIZE:], title=title, version=version):
        raise DataError(
            f"{name} is damaged: its contents do not match its checksum. "
            "Restore it from a copy, or move it to another folder."
        )
    return version
