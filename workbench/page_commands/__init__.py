"""What a page or a program may send to a run: commands and questions, with their bounds and what they do.

A module of this package that defines a command is found by itself: the websocket, the REST interface and its OpenAPI description then
accept it. What only the worker of a run needs is imported in `carry_out` or `answer`, because the server starts without it.
"""

from actr3d.registry import import_modules
from workbench.page_commands.command import COMMANDS, Name, PageCommand, PlainValue, Question, Seconds, Text

import_modules(__name__, __path__)

__all__ = ["COMMANDS", "Name", "PageCommand", "PlainValue", "Question", "Seconds", "Text"]
