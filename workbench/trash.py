"""Keeps deleted models, recordings and experiments in the trash folder of a models folder for a while, and restores them."""

from __future__ import annotations

import re
import secrets
import shutil
import time
from pathlib import Path, PurePosixPath

import msgspec

from actr3d.errors import Actr3dError
from actr3d.replacing import replace_file
from workbench.labels import Label

OWN = ".workbench"
"""The folder inside the models folder in which the workbench keeps recordings, experiments and deleted files."""
TRASH = "trash"
"""The folder in `OWN` for deleted files. Each folder in it is named by the time of deletion."""
TRASH_DAYS = 30
"""How long deleted files are kept [days]."""
ORIGINS = ".origins.json"
"""The ending of the file in the trash folder that says from where a deleted file or folder came."""
_STAMP = "%Y%m%d-%H%M%S"
_DELETED = re.compile(rf"{re.escape(OWN)}/{TRASH}/\d{{8}}-\d{{6}}/[0-9a-f]{{4}}-[^/\0]{{1,250}}")


class TrashError(Actr3dError):
    """What was deleted cannot be restored."""


class NotInTrashError(TrashError):
    """There is nothing of that name in the trash folder."""

    status = 404

    def __init__(self) -> None:
        super().__init__("it is no longer in the trash folder, or was not deleted in this workbench")


class Deleted(msgspec.Struct, frozen=True, kw_only=True):
    """What is known of a deleted file or folder."""

    origins: dict[str, str]
    """The former path inside the models folder of each file or folder that was moved with it, by its name in the trash folder; the last
    one is the deleted thing itself."""
    label: Label = Label()
    """What a user had written about it, for a recording."""

    @property
    def path(self) -> str:
        """The former path of the deleted thing inside the models folder."""
        return list(self.origins.values())[-1]


def move_to_trash(root: Path, path: Path, *companions: Path, label: Label | None = None) -> str:
    """Moves a file or folder to the trash folder of a models folder; returns its new path inside the models folder.

    Args:
        root: The models folder.
        path: The file or folder.
        companions: What belongs to it, and is restored with it; it lies beside it in the trash folder.
        label: What a user has written about it; `restore_from_trash` returns it again.

    Raises:
        OSError: If something cannot be moved.
    """
    trash = root / OWN / TRASH / time.strftime(_STAMP)
    trash.mkdir(parents=True, exist_ok=True)
    prefix = secrets.token_hex(2)
    moved: dict[str, Path] = {}
    for each in (*companions, path):
        name = f"{prefix}-{each.name}"
        moved[f"{prefix}-{len(moved)}-{each.name}" if name in moved else name] = each
    deleted = Deleted(origins={name: each.relative_to(root).as_posix() for name, each in moved.items()}, label=label or Label())
    *_, main = moved
    replace_file(trash / f"{main}{ORIGINS}", msgspec.json.encode(deleted))
    for name, each in moved.items():
        shutil.move(each, trash / name)  # its folder may be a link to another disk
    return (trash / main).relative_to(root).as_posix()


def restore_from_trash(root: Path, trash: str) -> Deleted:
    """Moves a deleted file or folder back to where it was, with what belongs to it; `trash` is the path that `move_to_trash` has returned.

    Raises:
        NotInTrashError: If it is not in the trash folder.
        TrashError: If there is something of its former name by now.
        OSError: If it cannot be moved.
    """
    where = root / trash
    facts = where.with_name(where.name + ORIGINS)
    try:
        if _DELETED.fullmatch(trash) is None:
            raise NotInTrashError
        deleted = msgspec.json.decode(facts.read_bytes(), type=Deleted)
    except (OSError, ValueError):
        raise NotInTrashError from None
    inside = all(not PurePosixPath(origin).is_absolute() and ".." not in PurePosixPath(origin).parts for origin in deleted.origins.values())
    if not (deleted.origins and inside and where.exists()):
        raise NotInTrashError
    taken = [origin for origin in deleted.origins.values() if (root / origin).exists()]
    if taken:
        raise TrashError(f"it cannot be restored: there is a '{taken[-1]}' already")
    for name, origin in deleted.origins.items():
        (root / origin).parent.mkdir(parents=True, exist_ok=True)
        shutil.move(where.with_name(name), root / origin)
    facts.unlink(missing_ok=True)
    return deleted


def names_in_trash(root: Path) -> list[str]:
    """Returns the former names of the files and folders in the trash folder of a models folder."""
    return [path.name.partition("-")[2] for path in (root / OWN / TRASH).glob("*/*")]


def empty_trash(root: Path) -> None:
    """Deletes what has been in the trash folder of a models folder for more than `TRASH_DAYS`."""
    oldest = time.strftime(_STAMP, time.localtime(time.time() - TRASH_DAYS * 86_400))
    for folder in (root / OWN / TRASH).glob("*"):
        if re.fullmatch(r"\d{8}-\d{6}", folder.name) and folder.name < oldest:
            shutil.rmtree(folder, ignore_errors=True)
