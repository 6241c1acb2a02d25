"""The secret key of this installation, used to seal its own recordings and to recognize them later.

The folder is not taken from platformdirs: it is one path, and an existing key must be found there on every system.
"""

from __future__ import annotations

import hmac
import os
import secrets
import tempfile
from contextlib import suppress
from pathlib import Path

SIZE = 32
"""The length of the key [bytes]."""


def key_file() -> Path:
    """Returns the path of the key: `actr3d/key` in `$XDG_DATA_HOME`, or in `~/.local/share`."""
    return Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share") / "actr3d" / "key"


def own_key() -> bytes | None:
    """Returns the key; None if there is none yet, or it cannot be read."""
    try:
        key = key_file().read_bytes()
    except (OSError, RuntimeError):  # the user has no home folder
        return None
    return key if len(key) == SIZE else None


def make_key() -> bytes | None:
    """Returns the key, and creates it first if there is none; None if it cannot be written."""
    key = own_key()
    if key is not None:
        return key
    try:
        file = key_file()
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        number, name = tempfile.mkstemp(dir=file.parent, prefix=".key-")  # readable only by its owner
        new = Path(name)
        try:
            with os.fdopen(number, "wb") as writing:
                writing.write(secrets.token_bytes(SIZE))
                writing.flush()
                os.fsync(number)
            with suppress(FileExistsError):  # another program was faster: its key is used
                os.link(new, file)
            if own_key() is None:  # the existing file is not a valid key
                new.replace(file)
        finally:
            new.unlink(missing_ok=True)
    except (OSError, RuntimeError):
        return None
    return own_key()


def seal(key: bytes, checksum: bytes) -> bytes:
    """Returns the seal of a recording with a checksum (HMAC-SHA256), which cannot be made without the key."""
    return hmac.digest(key, checksum, "sha256")


def is_sealed(checksum: bytes, seal_of_it: bytes) -> bool:
    """Returns whether a recording with this checksum was sealed with the key of this installation."""
    key = own_key()
    return key is not None and hmac.compare_digest(seal(key, checksum), seal_of_it)
