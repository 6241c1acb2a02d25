"""The model files: nothing outside the folder, nothing lost, nothing overwritten unseen."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import sleep
from types import ModuleType

import pytest

from actr3d.actr.loading.source_text import read_source
from workbench import files, loader, run_request
from workbench.files import MAX_FILE_SIZE, ConflictError, FileError, ModelFolder, NoSuchFileError
from workbench.loader import Outline, outline_of
from workbench.run_request import RunOptions, digest_of_file, start_of
from workbench.shipped import models_folder, shipped
from workbench.trash import restore_from_trash
from workbench.worker.messages import text_digest


@pytest.fixture
def folder(tmp_path: Path) -> ModelFolder:
    root = tmp_path / "models"
    (root / "tutorial").mkdir(parents=True)
    (root / "one.py").write_text("a = 1\n", encoding="utf-8")
    (root / "tutorial" / "two.py").write_text("b = 2\n", encoding="utf-8")
    (tmp_path / "secret.py").write_text("key = 1\n", encoding="utf-8")
    return ModelFolder(root)


def test_what_there_is(folder: ModelFolder, tmp_path: Path) -> None:
    for name in (".hidden.py", "notes.txt", "_helper.py"):
        (folder.root / name).write_text("", encoding="utf-8")
    (folder.root / "out.py").symlink_to(tmp_path / "secret.py")
    (folder.root / "away").symlink_to(tmp_path, target_is_directory=True)
    (folder.root / "inside.py").symlink_to(folder.root / "one.py")
    assert folder.paths() == ["inside.py", "one.py", "tutorial/two.py"]


@pytest.mark.skipif(os.name != "posix", reason="there are no such names")
def test_a_file_that_is_listed_is_opened_or_has_a_problem(folder: ModelFolder) -> None:
    odd = {
        "a:b.py": "must have no colon",
        "back\\slash.py": "must be a path with slashes",
        "zero\u200bwidth.py": "must have no invisible or invalid characters",
        f"{'é' * 110}.py": "at most 200 bytes",
    }
    for name in odd:
        (folder.root / name).write_text("", encoding="utf-8")
    assert set(odd) < set(folder.paths())
    for path in folder.paths():
        problem = folder.problem_of(path)
        if path in odd:
            assert problem is not None
            assert odd[path] in problem
            with pytest.raises(FileError, match=re.escape(f"the path of a model file: {problem}")):
                folder.read(path)
        else:
            assert problem is None
            assert folder.read(path).path == path


@pytest.mark.parametrize(
    "path",
    [
        "../secret.py",
        "tutorial/../../secret.py",
        "/etc/passwd.py",
        "//etc/x.py",
        "..\\secret.py",
        "C:\\x.py",
        "c:x.py",
        "one.py\0.py",
        "\0",
        "",
        ".",
        "..",
        "./one.py",
        "tutorial//two.py",
        "tutorial/",
        ".workbench/trash/x.py",
        "tutorial/.hidden.py",
        "one.txt",
        "one",
        "x" * 300 + ".py",
        "a/" * 300 + "b.py",
        "\ud800.py",
        "new\nline.py",
        "away/secret.py",
        "out.py",
        "loop.py",
    ],
)
def test_nothing_outside_the_folder_is_touched(folder: ModelFolder, tmp_path: Path, path: str) -> None:
    (folder.root / "away").symlink_to(tmp_path, target_is_directory=True)
    (folder.root / "out.py").symlink_to(tmp_path / "secret.py")
    (folder.root / "loop.py").symlink_to(folder.root / "loop.py")
    before = (tmp_path / "secret.py").read_bytes()
    for work in (
        lambda: folder.read(path),
        lambda: folder.save(path, "x", None),
        lambda: folder.save(path, "x", folder.version(tmp_path / "secret.py")),
        lambda: folder.copy("one.py", path),
        lambda: folder.rename("one.py", path),
        lambda: folder.rename(path, "new.py"),
        lambda: folder.delete(path),
    ):
        with pytest.raises(FileError):
            work()
    assert (tmp_path / "secret.py").read_bytes() == before
    assert (folder.root / "one.py").is_file()


def test_saving_without_a_conflict(folder: ModelFolder) -> None:
    file = folder.read("one.py")
    (folder.root / "one.py").chmod(0o640)
    saved = folder.save("one.py", "ä = 3\n", file.version)
    assert folder.read("one.py") == saved
    assert (folder.root / "one.py").stat().st_mode & 0o777 == 0o640
    assert [path.name for path in folder.root.iterdir() if path.name.endswith(".tmp")] == []


def test_a_conflict_is_reported_and_nothing_is_overwritten(folder: ModelFolder) -> None:
    file = folder.read("one.py")
    (folder.root / "one.py").write_text("other = 1\n", encoding="utf-8")
    with pytest.raises(ConflictError, match="has changed"):
        folder.save("one.py", "mine = 1\n", file.version)
    with pytest.raises(ConflictError, match="already"):
        folder.save("one.py", "mine = 1\n", None)
    assert folder.read("one.py").text == "other = 1\n"
    (folder.root / "one.py").unlink()
    with pytest.raises(ConflictError, match="no longer exists"):
        folder.save("one.py", "mine = 1\n", file.version)


def test_of_two_who_save_at_once_one_is_told_of_the_other(folder: ModelFolder, monkeypatch: pytest.MonkeyPatch) -> None:
    replace = files.replace_file

    def slow(target: Path, data: bytes) -> None:
        sleep(0.05)
        replace(target, data)

    def save(text: str) -> str | None:
        try:
            return folder.save("one.py", text, version).text
        except ConflictError:
            return None

    version = folder.read("one.py").version
    monkeypatch.setattr(files, "replace_file", slow)
    with ThreadPoolExecutor(2) as pool:
        saved = list(pool.map(save, ("first = 1\n", "second = 2\n")))
    assert saved.count(None) == 1
    assert folder.read("one.py").text in saved


@pytest.mark.parametrize("way", ["read", "start"])
def test_a_text_has_the_version_of_its_own_bytes(way: str, folder: ModelFolder, monkeypatch: pytest.MonkeyPatch) -> None:
    where = folder.root / "one.py"
    version = folder.version(where)
    read = Path.read_bytes

    def changed_then(path: Path) -> bytes:
        data = read(path)
        path.write_bytes(b"other = 1\n")
        return data

    monkeypatch.setattr(Path, "read_bytes", changed_then)
    if way == "read":
        file = folder.read("one.py")
        assert (file.text, file.version) == ("a = 1\n", version)
    else:
        start = start_of(where, RunOptions())
        assert (start.source, start.version) == ("a = 1\n", version)


def test_a_new_file_may_lie_in_a_new_folder(folder: ModelFolder) -> None:
    assert folder.save("mine/first.py", "", None).text == ""
    assert "mine/first.py" in folder.paths()


def test_copying_and_renaming_replace_nothing(folder: ModelFolder) -> None:
    assert folder.copy("one.py", "copy.py").text == "a = 1\n"
    for work in (folder.copy, folder.rename):
        with pytest.raises(ConflictError):
            work("one.py", "tutorial/two.py")
        with pytest.raises(NoSuchFileError):
            work("none.py", "new.py")
    assert folder.rename("copy.py", "tutorial/three.py").path == "tutorial/three.py"
    assert folder.paths() == ["one.py", "tutorial/three.py", "tutorial/two.py"]


def test_what_is_deleted_is_in_the_trash(folder: ModelFolder) -> None:
    trash = folder.delete("tutorial/two.py")
    assert (folder.root / trash).read_text(encoding="utf-8") == "b = 2\n"
    assert folder.paths() == ["one.py"]
    with pytest.raises(NoSuchFileError):
        folder.delete("tutorial/two.py")
    assert restore_from_trash(folder.root, trash).path == "tutorial/two.py"
    assert folder.read("tutorial/two.py").text == "b = 2\n"


def test_what_is_no_text_or_too_large_is_refused(folder: ModelFolder) -> None:
    (folder.root / "bytes.py").write_bytes(b"x = '\xff'\n")
    with pytest.raises(Exception, match="line 1 is not UTF-8"):
        folder.read("bytes.py")
    with pytest.raises(FileError, match="must be <= 1,000,000 bytes"):
        folder.save("large.py", "x" * (MAX_FILE_SIZE + 1), None)
    with pytest.raises(FileError, match="unpaired surrogate character"):
        folder.save("half.py", "\ud800", None)
    (folder.root / "large.py").write_bytes(b"#" * (MAX_FILE_SIZE + 1))
    with pytest.raises(FileError, match="larger"):
        folder.read("large.py")


def test_a_folder_that_cannot_be_read_hides_no_other(folder: ModelFolder, monkeypatch: pytest.MonkeyPatch) -> None:
    usual = Path.iterdir

    def iterdir(path: Path) -> Iterator[Path]:
        if path.name == "tutorial":
            raise PermissionError(13, "Permission denied", str(path))
        return usual(path)

    monkeypatch.setattr(Path, "iterdir", iterdir)
    assert folder.paths() == ["one.py"]


def test_a_folder_that_is_no_file(folder: ModelFolder) -> None:
    (folder.root / "odd.py").mkdir()
    for work in (lambda: folder.read("odd.py"), lambda: folder.save("odd.py", "", None), lambda: folder.delete("odd.py")):
        with pytest.raises(FileError):
            work()


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is forbidden to root")
def test_a_file_that_may_not_be_written(folder: ModelFolder) -> None:
    folder.root.chmod(0o500)
    with pytest.raises(FileError, match="cannot write"):
        folder.save("new.py", "", None)
    folder.root.chmod(0o700)


def test_a_read_only_file_is_not_written_over(folder: ModelFolder) -> None:
    file = folder.read("one.py")
    (folder.root / "link.py").symlink_to(folder.root / "one.py")
    (folder.root / "one.py").chmod(0o444)
    for name in ("one.py", "link.py"):
        with pytest.raises(FileError, match=f"cannot write '{name}': it is read-only"):
            folder.save(name, "mine = 1\n", file.version)
    assert folder.read("one.py") == file
    with pytest.raises(ConflictError):
        folder.rename("tutorial/two.py", "one.py")
    assert folder.copy("one.py", "mine.py").text == file.text
    folder.save("mine.py", "mine = 1\n", file.version)
    folder.delete("one.py")


def test_own_copies_of_the_shipped_models_may_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "installed").mkdir()
    (tmp_path / "installed" / "one.py").write_text("a = 1\n", encoding="utf-8")
    (tmp_path / "installed" / "one.py").chmod(0o444)
    monkeypatch.setattr("workbench.shipped.shipped", lambda: tmp_path / "installed")
    own = ModelFolder(models_folder(None, tmp_path, tmp_path))
    assert own.save("one.py", "b = 1\n", own.read("one.py").version).text == "b = 1\n"


def test_where_the_models_are(tmp_path: Path) -> None:
    present, home = tmp_path / "present", tmp_path / "home"
    present.mkdir()
    home.mkdir()
    at_home = models_folder(None, present, home)
    assert at_home.parent == home
    assert (at_home / "counting.py").read_bytes() == (shipped() / "counting.py").read_bytes()
    (at_home / "counting.py").write_text("mine = 1\n", encoding="utf-8")
    assert models_folder(None, present, home) == at_home
    assert (at_home / "counting.py").read_text(encoding="utf-8") == "mine = 1\n"
    (present / "models").mkdir()
    assert models_folder(None, present, home) == present / "models"
    assert models_folder(tmp_path / "named", present, home) == tmp_path / "named"
    assert (tmp_path / "named").is_dir()


def test_a_file_keeps_its_encoding_and_its_line_ends(folder: ModelFolder) -> None:
    (folder.root / "old.py").write_bytes(b"# -*- coding: latin-1 -*-\r\nname = '\xe4'\r\n")
    file = folder.read("old.py")
    folder.save("old.py", file.text + "other = 'ö'\n", file.version)
    assert (folder.root / "old.py").read_bytes() == b"# -*- coding: latin-1 -*-\r\nname = '\xe4'\r\nother = '\xf6'\r\n"
    (folder.root / "marked.py").write_bytes("name = 'ä'\r\n".encode("utf-8-sig"))
    read = folder.read("marked.py")
    folder.save("marked.py", read.text + "x = 1\n", read.version)
    assert (folder.root / "marked.py").read_bytes() == "name = 'ä'\r\nx = 1\r\n".encode("utf-8-sig")
    with pytest.raises(FileError, match="'€' is not in the encoding"):
        folder.save("new.py", "# coding: latin-1\nprice = '€'\n", None)
    with pytest.raises(FileError, match="cannot be used"):
        folder.save("new.py", "# coding: klingon\n", None)


def readings(monkeypatch: pytest.MonkeyPatch, module: ModuleType) -> list[Path]:
    """Returns a list of the files whose source a module reads from now on."""
    read: list[Path] = []

    def reading(path: Path) -> str:
        read.append(path)
        return read_source(path)

    monkeypatch.setattr(module, "read_source", reading)
    return read


def test_the_description_of_a_file_in_a_list_is_read_again_only_after_a_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read = readings(monkeypatch, loader)
    file = tmp_path / "model.py"
    for text, outline in (
        ("'''Counts.'''", Outline("Counts.", "program")),
        ("'''Walks.'''\ndef build(p) -> Simulation: ...", Outline("Walks.", "simulation")),
        ("# -*- coding: latin-1 -*-\n'''\xfcben'''", Outline("üben", "program")),
    ):
        file.write_bytes(text.encode("latin-1"))
        assert [outline_of(file) for _ in range(3)] == [outline] * 3
    assert len(read) == 3
    other = tmp_path / "other"  # put in its place, as editors do
    other.write_text("'''Reads.'''".ljust(file.stat().st_size), encoding="utf-8")
    written = file.stat().st_mtime_ns
    os.utime(other, ns=(written, written))
    other.replace(file)
    assert outline_of(file).title == "Reads."
    for data in (b"\xff", b"x" * (MAX_FILE_SIZE + 1), b"# coding: none\n", b"\0"):
        file.write_bytes(data)
        assert outline_of(file) == Outline()
    file.unlink()
    assert outline_of(file) == outline_of(tmp_path) == Outline()


def test_the_digest_of_a_file_is_computed_again_only_when_the_file_has_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read = readings(monkeypatch, run_request)
    file = tmp_path / "model.py"
    for text in ("a = 1", "a = 22", "a = 1"):
        file.write_text(text, encoding="utf-8")
        assert [digest_of_file(file) for _ in range(3)] == [text_digest(text)] * 3
    assert len(read) == 3
    file.write_bytes(b"\xff\xff")
    assert digest_of_file(file) is None
    file.unlink()
    assert digest_of_file(file) is None


def test_a_name_that_is_too_long_is_said_to_be_too_long(folder: ModelFolder) -> None:
    for path in ("n" * 198 + ".py", "é" * 100 + ".py", "n" * 201 + "/one.py"):
        with pytest.raises(
            FileError, match=r"^the path of a model file: each name in it must have at most 200 bytes; many letters have more than one$"
        ):
            folder.locate(path)
    assert folder.locate("n" * 197 + ".py").name.endswith("n.py")
    with pytest.raises(FileError, match="must lie inside the models folder, without hidden parts"):
        folder.locate(".hidden.py")
