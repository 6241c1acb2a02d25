"""The process that answers questions about texts, one after the other. It reads files, and executes none."""

from __future__ import annotations

import sys
from pathlib import Path

import msgspec

import actr3d
from actr3d.errors import Actr3dError
from workbench.language.answers import LanguageError
from workbench.language.language_question import LanguageQuestion
from workbench.worker.channel import Channel
from workbench.worker.messages import CommandMessage, Leave, Reply, shortened


def serve(channel: Channel) -> None:
    """Answers questions until the server asks to end."""
    sys.path[:] = safe_path(Path(channel.start.folder))  # before jedi is imported
    from workbench.language.python_answers import PythonAnswers
    from workbench.language.questions import Assistant

    assistant = Assistant(PythonAnswers(Path(channel.start.folder)))
    while not isinstance(request := channel.receive(), Leave):
        if isinstance(request, CommandMessage):
            try:
                answer = assistant.answer(LanguageQuestion.model_validate_json(request.command))
                channel.post(Reply(id=request.id, result=msgspec.json.encode(answer)))
            except LanguageError as error:
                channel.post(Reply(id=request.id, error=shortened(str(error)), line=error.line))
            except Actr3dError as error:
                channel.post(Reply(id=request.id, error=shortened(str(error))))
            except MemoryError:
                raise  # what is left may be incomplete: the server starts another process
            except Exception as error:  # noqa: BLE001 - jedi may fail on any half-written text
                channel.post(Reply(id=request.id, error=shortened(f"this text cannot be read: {type(error).__name__}")))


def safe_path(folder: Path) -> list[str]:
    """Returns where modules are found: installed packages first, the library last; neither the working directory nor the models folder."""
    library = Path(actr3d.__file__).resolve().parents[1]

    def is_safe(path: Path) -> bool:
        return path not in (library, Path.cwd()) and not path.is_relative_to(folder.resolve())

    return [*(path for path in sys.path if path and is_safe(Path(path).resolve())), str(library)]
