"""The REST interface for recordings: lists, downloads, imports, compares, opens, replays, labels and deletes them."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from fastapi import APIRouter, Query, Request
from fastapi.responses import Response
from pydantic import Field
from starlette.requests import ClientDisconnect

from actr3d.errors import RecordingError
from actr3d.values import to_json
from workbench.auth import BODY_TIME, LARGEST_UPLOAD, UPLOAD_TYPE, too_large
from workbench.disconnects import DisconnectedError
from workbench.labels import Label
from workbench.listing import MAX_LISTED
from workbench.open_file import OpenFile, of_kinds
from workbench.page_commands import Name
from workbench.page_message import PageMessage
from workbench.recording_index import Summary
from workbench.recordings import Recordings
from workbench.retention import erase, is_complete
from workbench.routes import Id, code_json, json_response, made, sessions_of
from workbench.sessions import SessionError, Sessions

router = APIRouter(prefix="/api")


File = Literal["sqlite", "events.csv", "states.csv", "replay.html"]
KINDS: dict[File, str] = {
    "sqlite": UPLOAD_TYPE,
    "events.csv": "text/csv",
    "states.csv": "text/csv",
    "replay.html": "text/html",
}
"""The file formats in which a recording can be downloaded, with their media types."""


class UploadError(RecordingError):
    """A file is too large to be received."""

    status = 413


class KnownLabel(PageMessage):
    """What a recording's label was when a user began to change it."""

    name: Annotated[str, Field(max_length=100)] = ""
    note: Annotated[str, Field(max_length=2_000)] = ""
    tags: tuple[Annotated[str, Field(max_length=40)], ...] = Field(default=(), max_length=20)

    @property
    def label(self) -> Label:
        """The label, without spaces around its texts, and each tag once."""
        tags = tuple(dict.fromkeys(tag.strip() for tag in self.tags if tag.strip()))
        return Label(name=self.name.strip(), note=self.note.strip(), tags=tags)


class LabelRequest(KnownLabel):
    """What a user writes about a recording; what is left out is not changed."""

    known: KnownLabel | None = None
    """The label as the user saw it before the change; if given, a field that somebody else has changed since is not replaced."""


class Trusting(PageMessage):
    """Whether code of a recording may be run."""

    trust: bool = Field(default=False, strict=True)
    """Whether the code in the recording may be run although this installation did not make it."""


class OpenRequest(Trusting):
    """Options for opening a recording."""

    real_time: bool = False
    """As for a model."""


class Pair(PageMessage):
    """Two recordings to compare."""

    first: Annotated[str, Field(max_length=160)]
    second: Annotated[str, Field(max_length=160)]
    kinds: tuple[Name, ...] = Field(default=(), max_length=50)
    """The kinds of events to compare; empty for all."""


@router.get("/recordings")
async def recordings(
    request: Request, first: Annotated[int, Query(ge=0, le=1_000_000)] = 0, most: Annotated[int, Query(ge=1, le=MAX_LISTED)] = MAX_LISTED
) -> Response:
    """Lists recordings, newest first: the `total` number, and summaries from number `first` on.

    `problem` says why a recording cannot be read, `session` which session is still writing it; `number` tells those of a tree apart that
    are called the same; `warning` says why labels are missing.
    """
    sessions = sessions_of(request)
    total, found = await sessions.listing.some(first, most)
    writing = sessions.writing()
    listed = await asyncio.to_thread(_listed, sessions.recordings, found, writing)
    problem = await asyncio.to_thread(lambda: sessions.recordings.labels.problem)
    page = {"total": total, "recordings": listed, "warning": problem}
    return json_response(await asyncio.to_thread(to_json, page))


@router.post(
    "/recordings/import",
    status_code=201,
    openapi_extra={"requestBody": {"required": True, "content": {UPLOAD_TYPE: {"schema": {"type": "string", "format": "binary"}}}}},
)
async def import_recording(request: Request, name: Annotated[str, Query(min_length=1, max_length=100)]) -> Response:
    """Adds a recording file, the body of the request, to the recordings, and returns its summary; 409 if it cannot be read as a recording.

    Its code is not run. The `name`, that of the file, becomes its label, so that it is never deleted automatically.
    """
    sessions = sessions_of(request)
    recordings = sessions.recordings
    part = await asyncio.to_thread(recordings.unfinished)
    try:
        await _receive(request, part)
        path = await asyncio.to_thread(recordings.add, part, name.removesuffix(".sqlite"))
    finally:
        await asyncio.to_thread(part.unlink, missing_ok=True)
    summary = await sessions.listing.one(path.stem)
    if summary.problem is not None:
        await asyncio.to_thread(erase, path)
        raise RecordingError(f"the file cannot be read: {summary.problem}")
    await asyncio.to_thread(recordings.labels.change, path.stem, {"name": name.removesuffix(".sqlite")})
    sessions.announce_recordings()
    return json_response(to_json(await _recording(sessions, path.stem)), 201)


async def _receive(request: Request, to: Path) -> None:
    """Writes the body of a request to a new file.

    Raises:
        UploadError: If the body is too large.
        DisconnectedError: If the client disconnects before its end, or nothing of it arrives for `BODY_TIME`.
        OSError: If the file cannot be written.
    """
    size, parts = 0, aiter(request.stream())
    with await asyncio.to_thread(to.open, "xb") as file:
        while True:
            try:
                part = await asyncio.wait_for(anext(parts), BODY_TIME)
            except StopAsyncIteration:
                return
            except TimeoutError:
                raise DisconnectedError(f"nothing of the file has arrived for {BODY_TIME:g} s") from None
            except ClientDisconnect:
                raise DisconnectedError("the client has disconnected before the end of the file") from None
            size += len(part)
            if size > LARGEST_UPLOAD:
                raise UploadError(too_large(LARGEST_UPLOAD))
            await asyncio.to_thread(file.write, part)


@router.get("/recordings/{recording}")
async def recording(request: Request, recording: Id) -> Response:
    """Returns the summary of a recording."""
    return json_response(to_json(await _recording(sessions_of(request), recording)))


@router.get("/recordings/{recording}/file", **of_kinds(KINDS.values()))
async def download(request: Request, recording: Id, form: File = "sqlite") -> Response:
    """Returns a file: the recording itself, its events or states as CSV, or an HTML file that plays its scene beside its trace.

    For a run that is still going on, it contains what is recorded by now. 409 if there is nothing to return, for example no states.
    """
    sessions = sessions_of(request)
    path = sessions.recordings.path(recording)
    if form == "sqlite" and is_complete(path):
        file = sessions.recordings.opened(recording)
    else:
        options = {"models": str(sessions.folder.root)} if form == "replay.html" else {}
        file = await made(request, form, path, **options)
    return OpenFile(file, KINDS[form], f"{recording}.{form}")


@router.get("/recordings/{recording}/curves")
async def recorded_curves(
    request: Request,
    recording: Id,
    name: Annotated[list[Name] | None, Query(max_length=500)] = None,
    first: Annotated[float, Query(ge=0, lt=1e9, allow_inf_nan=False)] = 0.0,
    most: Annotated[int, Query(ge=2, le=20_000)] = 2_000,
    last: Annotated[float | None, Query(ge=0, lt=1e9, allow_inf_nan=False)] = None,
) -> Response:
    """Returns curves of a recorded run over time, for plots: the named ones, or all; the run may still be going on.

    They are returned as the question `curves` of a session returns them; see `workbench.page_commands.bodies.Curves`.
    """
    path = sessions_of(request).recordings.path(recording)
    return OpenFile(await made(request, "curves", path, names=name, first=first, most=most, last=last), "application/json")


@router.post("/recordings/{recording}/open", status_code=201)
async def open_recording(request: Request, recording: Id, body: OpenRequest | None = None) -> dict[str, Any]:
    """Starts a session that repeats a recorded run, or returns the open session whose `recorded` is this recording.

    The whole recorded run is available at once: the session can go to any time of it. Once a user changes the run, the session is known by
    the branch that it writes then, and the recording can be opened again, unchanged. Opening runs the code in the recording: 403 if
    this installation did not make it, unless `trust` is true.
    """
    said = body or OpenRequest()
    return (await sessions_of(request).reopen(recording, trust=said.trust, real_time=said.real_time)).summary()


@router.get("/recordings/{recording}/code")
async def recorded_code(request: Request, recording: Id) -> dict[str, Any]:
    """Returns the code that opening or replaying a recording runs: the model's `source`, and the texts of its `helpers` by name.

    `made_here` says whether this installation made the recording and nobody has changed it since.
    """
    start = await sessions_of(request).recorded_start(recording)
    return code_json(start.made_here, start.file, start.source, {name: text for name, (_, text) in start.helpers.items()})


@router.post("/recordings/{recording}/replay")
async def replay(request: Request, recording: Id, body: Trusting | None = None) -> dict[str, Any]:
    """Runs a recording again in a process of its own and compares all bytes; it is cancelled when the clients disconnect.

    `verdict` is "agrees", "agrees up to its end" (that of a recording which does not go to the end of its run), "differs", or null if it is
    unknown; `text` says what was compared, where it differs, or why the verdict is unknown.
    403 if this installation did not make the recording, unless `trust` is true.
    """
    sessions = sessions_of(request)
    await sessions.trusted(recording, body is not None and body.trust)
    return await sessions.replays.run(sessions.recordings.path(recording), request.is_disconnected)


@router.get("/recordings/{recording}/replay")
async def replaying(request: Request, recording: Id) -> dict[str, Any]:
    """Returns the share of a recording that has been run again, from 0 to 1; null if no replay is in progress."""
    sessions = sessions_of(request)
    return {"share": sessions.replays.share(sessions.recordings.path(recording))}


@router.post("/recordings/{recording}/label")
async def label_recording(request: Request, recording: Id, body: LabelRequest) -> dict[str, Any]:
    """Sets the name, the note or the tags of a recording, even of one that is being written; it is then never deleted automatically.

    409 if somebody else has changed the same field since it was as `known` says.
    """
    sessions = sessions_of(request)
    sessions.recordings.path(recording)
    new, known = body.label, None if body.known is None else body.known.label
    changes = {field: getattr(new, field) for field in Label.__struct_fields__ if field in body.model_fields_set}
    label = await asyncio.to_thread(sessions.recordings.labels.change, recording, changes, known)
    sessions.announce_recordings()
    return {"label": msgspec.structs.asdict(label)}


@router.post("/recordings/{recording}/delete")
async def delete_recording(request: Request, recording: Id) -> dict[str, Any]:
    """Moves a recording to the trash folder; 409 while a run is still writing it, here or in another program."""
    sessions = sessions_of(request)
    if recording in sessions.writing():
        raise SessionError("an open run still writes this recording; restart its model or close its session, then delete it")
    trash = await asyncio.to_thread(sessions.recordings.delete, recording)
    sessions.announce_recordings()
    return {"trash": trash}


@router.post("/compare")
async def compare_recordings(request: Request, body: Pair) -> Response:
    """Returns the differences of two recordings: parameters, lines of the model, and the first event that differs."""
    sessions = sessions_of(request)
    names = (body.first, body.second)
    first, second = [sessions.recordings.path(name) for name in names]
    with await made(request, "comparison", first, second, kinds=body.kinds) as file:
        differences = msgspec.json.decode(await asyncio.to_thread(file.read), type=dict[str, msgspec.Raw])
    runs = to_json([await _recording(sessions, name) for name in names]).encode()
    return json_response(msgspec.json.encode({"runs": msgspec.Raw(runs), **differences}))


async def _recording(sessions: Sessions, name: str) -> dict[str, Any]:
    """Returns the summary of a recording and the session that is writing it."""
    summary = await sessions.listing.one(name)
    (listed,) = await asyncio.to_thread(_listed, sessions.recordings, [summary], sessions.writing())
    return listed


def _listed(recordings: Recordings, summaries: Sequence[Summary], writing: Mapping[str, str]) -> list[dict[str, Any]]:
    """Returns summaries with the labels and numbers of the recordings, and the sessions that are writing them."""
    labels = recordings.labels.all()
    numbers = recordings.numbers.of(summaries, labels)

    def listed(one: Summary) -> dict[str, Any]:
        label = msgspec.structs.asdict(labels.get(one.id, Label()))
        return {**vars(one), "session": writing.get(one.id), "label": label, "number": numbers.get(one.id, 1)}

    return [listed(one) for one in summaries]
