"""Answers the questions of a page about a text, from ACT-R and Python."""

from __future__ import annotations

import builtins
import keyword
import re
import subprocess
from dataclasses import asdict, replace
from typing import Any

from ruff import find_ruff_bin

from workbench.language import actr_answers
from workbench.language.answers import Completion, Definition, Documentation, Hover, Item, LanguageError, Renaming
from workbench.language.explicit_names import ExplicitText
from workbench.language.language_question import LanguageQuestion
from workbench.language.model_text import ModelText
from workbench.language.python_answers import PythonAnswers
from workbench.language.references import References
from workbench.language.tokens import line_of

FORMAT_TIME = 5.0
"""Maximum time that formatting may take [s]."""
_MARK = "completed_here"
"""Takes the place of the name that is not written yet."""


class Assistant:
    """Answers questions about the texts of a folder."""

    def __init__(self, python: PythonAnswers) -> None:
        self._python = python

    def answer(self, question: LanguageQuestion) -> Any:
        """Returns the answer, for JSON; None if there is none.

        Raises:
            LanguageError: If it cannot be given.
        """
        self._python.forget()
        if question.ask == "format":
            return {"text": formatted(question.text)}
        units = CodeUnits(question.text)
        at = units.position(question.at)
        model = ModelText(question.text)
        if question.ask == "complete":
            return _plain(self._complete(model, question.path, at), units)
        if question.ask == "document item":
            return _plain(self._python.document_item(ExplicitText(model), question.path, at, question.name), units)
        if question.ask == "document":
            return _plain(self._document(model, question.path, at), units)
        if question.ask == "signature":
            in_text = model.text_at(at) is not None
            own = actr_answers.sign(model, at)
            signatures = [] if in_text else [own] if own else self._python.signatures(ExplicitText(model), question.path, at)
            return [asdict(one) for one in signatures]
        if question.ask == "define":
            return _plain(self._define(model, question.path, at), units)
        renaming = self._rename(model, question.path, at, question.name)
        size = len(renaming.name.encode("utf-16-le")) // 2
        starts = [units.unit(start) for start in renaming.starts]
        changes = [[start, start + size] for start in starts]
        return {"name": renaming.name, "what": renaming.what, "changes": changes, "unchanged": _unchanged(question.text, renaming)}

    def _complete(self, model: ModelText, path: str, at: int) -> Completion:
        attributes = self._python.after(model.text, path)
        inside = actr_answers.complete(model, at, attributes)
        if inside is not None:
            return inside
        start = at - len(re.search(r"\w*$", model.text[:at])[0])  # type: ignore[index] # it always matches
        marked = model if start < at else ModelText(f"{model.text[:at]}{_MARK}{model.text[at:]}")
        own, alone = actr_answers.complete_name(marked, at, attributes)
        python: list[Item] = [] if alone else self._python.complete(ExplicitText(model), path, at)
        parts = actr_answers.complete_part(model.text, start) if model.text[start - 1 : start] != "." else []
        return Completion(start=start, items=actr_answers.distinct([*own, *parts, *python]))

    def _document(self, model: ModelText, path: str, at: int) -> Hover | None:
        found = actr_answers.document(model, at)
        name = model.name_at(at)
        part = actr_answers.part_of(model, name) if name is not None else None
        if found is not None and part is not None:
            kind = next((one for one in model.names if one.start > part.start and one.text == part.kind), None)
            said = None if kind is None else self._python.document(ExplicitText(model), path, kind.start)
            about = [said.text.split("\n\n")[0]] if said is not None else []
            return replace(found, text="\n\n".join(text for text in (*about, found.text) if text))
        if found is not None or model.text_at(at) is not None:
            return found
        if name is None:
            return None
        said = self._python.document(ExplicitText(model), path, min(at, name.end - 1))
        return None if said is None else Hover(start=name.start, end=name.end, title=said.title, text=said.text)

    def _define(self, model: ModelText, path: str, at: int) -> Definition | None:
        place = actr_answers.define(model, at)
        if place is not None:
            return Definition(path=path, at=place, name="")
        if model.text_at(at) is not None or model.name_at(at) is None:
            return None
        return self._python.define(ExplicitText(model), path, at)

    def _rename(self, model: ModelText, path: str, at: int, new: str) -> Renaming:
        words = References(model, self._python, path)
        found = words.uses(at)
        allowed = re.fullmatch(r"[\w.]+", new) if found.what == "slot" else new.isidentifier() and not keyword.iskeyword(new)
        if not new:  # the page asks what will be renamed
            return found
        if not allowed:
            raise LanguageError(f"'{new}' is not a name")
        if new != found.name:
            if self._is_taken(model, found, at, new):
                raise LanguageError(f"there is a {found.what} '{new}' already")
            if found.what != "slot":
                self._check_meaning(words, path, found, at, new)
        return found

    def _check_meaning(self, words: References, path: str, found: Renaming, at: int, new: str) -> None:
        """Checks that a new name in the code hides nothing, and that no other name means the same once it is written.

        Raises:
            LanguageError: If it does.
        """
        if hasattr(builtins, new):
            raise LanguageError(f"'{new}' is a name of Python itself")
        module = self._python.origin(words.explicit, path, new)
        if module:
            raise LanguageError(f"'{new}' is imported from {module} already")
        owner = words.owner(at)
        taken = words.members.meaning(owner, found.name, new) if owner else ""
        if taken:
            raise LanguageError(taken)
        if not words.mentions(new):
            return
        text, starts = _renamed(words.model.text, found, new)
        here = max((start for old, start in zip(found.starts, starts, strict=True) if old <= at + 1), default=starts[0])
        same, _ = References(ModelText(text), self._python, path).places(new, here)
        different = same ^ set(starts)
        if different:
            line = line_of(text, min(different))
            raise LanguageError(f"'{new}' already has a meaning in line {line}", line=line)

    @staticmethod
    def _is_taken(model: ModelText, found: Renaming, at: int, new: str) -> bool:
        """Returns whether a slot, a variable or a part of the new name exists already."""
        text = model.text_at(at) or model.name_at(at)
        if text is None or found.what == "name":
            return False
        if found.what == "slot":
            return any(slot.text == new for one in model.texts for slot in one.slots)
        names = {piece.text for piece in model.variables_of(text.method)} if found.what == "variable" else set[str]()
        return new in names or new == "self" or new in model.parts_of(text.agent)


class CodeUnits:
    """Converts between numbers of characters and numbers of UTF-16 code units, which the page counts."""

    def __init__(self, text: str) -> None:
        self._large = [at for at, character in enumerate(text) if character > "\uffff"] if text and max(text) > "\uffff" else []
        self._length = len(text)

    def position(self, unit: int) -> int:
        """Returns the number of characters before a code unit; that of the whole text if it lies behind."""
        before = sum(1 for number, at in enumerate(self._large) if at + number < unit)
        return max(0, min(unit - before, self._length))

    def unit(self, position: int) -> int:
        """Returns the number of code units before a character."""
        return position + sum(1 for at in self._large if at < position)


def _renamed(text: str, found: Renaming, new: str) -> tuple[str, list[int]]:
    """Returns a text with a new name, and the places of that name in it."""
    pieces: list[str] = []
    starts: list[int] = []
    end = length = 0
    for start in found.starts:
        pieces += [text[end:start], new]
        length += start - end
        starts.append(length)
        length += len(new)
        end = start + len(found.name)
    return "".join([*pieces, text[end:]]), starts


def _unchanged(text: str, found: Renaming) -> list[int]:
    """Returns the lines in which a name stays as a word of any meaning, also in lower case, or as `big_pole` for `BigPole`."""
    forms = {found.name, re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", found.name)}
    begin = r"(?:(?<!\w)|(?<=\\[abfnrtv]))"  # in a string, it may follow an escape: "\nsize"
    words = re.finditer(rf"{begin}(?:{'|'.join(map(re.escape, sorted(forms)))})\b", text, re.IGNORECASE)
    starts = set(found.starts)
    return sorted({line_of(text, one.start()) for one in words if one.start() not in starts})


def _plain(answer: Completion | Definition | Documentation | Hover | None, units: CodeUnits) -> Any:
    """Returns an answer for JSON, with positions as the page counts them."""
    if answer is None:
        return None
    plain = asdict(answer)
    for field in ("start", "end", "at"):
        if plain.get(field) is not None:
            plain[field] = units.unit(plain[field])
    return plain


def formatted(text: str) -> str:
    """Returns a text as `ruff format` writes it.

    Raises:
        LanguageError: If it is not valid Python, or takes too long.
    """
    command = [find_ruff_bin(), "format", "--isolated", "--no-cache", "--stdin-filename", "model.py", "-"]
    try:
        done = subprocess.run(command, input=text.encode(errors="surrogatepass"), capture_output=True, timeout=FORMAT_TIME, check=False)
    except subprocess.TimeoutExpired:
        raise LanguageError("the text was not formatted: that takes too long") from None
    if done.returncode != 0:
        said = done.stderr.decode(errors="replace").strip()
        found = re.search(r"model\.py:(\d+):\d+: (.*)", said)
        reason = f"line {found[1]}: {found[2]}" if found else said[:300]
        raise LanguageError(f"the text was not formatted: {reason}", line=int(found[1]) if found else None)
    return done.stdout.decode()
