"""Files that are written whole."""

from __future__ import annotations

import errno
import os
from contextlib import ExitStack
from pathlib import Path

import pytest

from actr3d.replacing import creating


@pytest.mark.parametrize("links", [True, False])
def test_a_new_file_is_made_whole_and_replaces_none_also_without_hard_links(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, links: bool
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EPERM, "Operation not permitted")

    if not links:
        monkeypatch.setattr(os, "link", refuse)
    target = tmp_path / "new"
    with creating(target) as part:
        part.write_text("all", encoding="utf-8")
        assert not target.exists()
    assert target.read_text(encoding="utf-8") == "all"
    with pytest.raises(FileExistsError), creating(target) as part:
        part.write_text("other", encoding="utf-8")
    other = tmp_path / "other"
    with ExitStack() as opened:
        opened.enter_context(creating(other)).write_text("mine", encoding="utf-8")
        other.write_text("theirs", encoding="utf-8")
        with pytest.raises(FileExistsError):
            opened.close()
    assert other.read_text(encoding="utf-8") == "theirs"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["new", "other"]
