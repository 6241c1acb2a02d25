"""Computes the checksums of a recording: a chain for each of its tables, one for its facts, and one of everything."""

from __future__ import annotations

import hashlib
from struct import pack

from actr3d.recording.schema import COLUMNS, FORMAT


class Checksums:
    """Computes the checksums of a recording, row by row, while it is written or read; SHA-256.

    The checksum of a row covers the row before it in its table, so a row cannot be changed, removed or moved without
    changing all that follow. The checksum of the whole recording covers the last checksum of each table, and all facts.
    """

    def __init__(self) -> None:
        self.last = {table: _digest(table) for table in COLUMNS}
        """The checksum of the last row of each table."""
        self.facts: dict[str, bytes] = {}
        """The checksum of each fact's value, by the fact's name."""

    def row(self, table: str, *values: int | str | bytes) -> bytes:
        """Returns the checksum of the next row of a table."""
        self.last[table] = checksum = _digest(self.last[table], *values)
        return checksum

    def begin(self, table: str, checksum: bytes | None) -> None:
        """Continues a table after the row with a given checksum; None for its start."""
        self.last[table] = _digest(table) if checksum is None else checksum

    def fact(self, name: str, value: str) -> None:
        """Adds a fact; a later fact replaces an earlier one of the same name."""
        self.facts[name] = _digest(value)

    def whole(self) -> bytes:
        """Returns the checksum of the whole recording up to now."""
        facts = [part for fact in sorted(self.facts.items()) for part in fact]
        return _digest(FORMAT, *self.last.values(), *facts)


def _digest(*values: int | str | bytes) -> bytes:
    """Returns the SHA-256 of some values, with types and lengths, so that other values or other divisions give another digest."""
    digest = hashlib.sha256()
    for value in values:
        if isinstance(value, int):
            digest.update(pack("<cq", b"i", value))
            continue
        data = value.encode() if isinstance(value, str) else value
        digest.update(pack("<cq", b"t" if isinstance(value, str) else b"b", len(data)))
        digest.update(data)
    return digest.digest()
