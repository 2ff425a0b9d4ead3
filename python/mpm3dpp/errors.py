# SPDX-License-Identifier: BSD-3-Clause
"""What the program says when something is wrong: one sentence, never a traceback.

`CaseError` is a mistake of the user (exit code 2), `RunError` a run that had to stop (exit code 1).
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic_core import PydanticCustomError

Path = tuple[str | int, ...]
NO_VALUE: Any = object()
VIOLATION = "case_rule"


class CaseError(Exception):
    """A mistake in a case, as one sentence.

    Attributes:
        key: the key at fault, written as in the case file, for example `body.left.velocity[1]`.
        place: where it stands, for example `case.toml:14`; empty for a case built in Python.
        rule: what must hold, for example `must be > 0`.
        remedy: what the user can do about it.
        value: the value given, where there is one.
    """

    def __init__(
        self, rule: str, remedy: str = "", *, key: str = "", place: str = "", value: Any = NO_VALUE
    ) -> None:
        self.rule, self.remedy, self.key, self.place, self.value = rule, remedy, key, place, value
        super().__init__(self.sentence())

    def sentence(self) -> str:
        """Return `place: key = value rule; remedy`, with the parts that are known."""
        place = f"{self.place}: " if self.place else ""
        value = "" if self.value is NO_VALUE else show(self.value)
        subject = " = ".join(part for part in (self.key, value) if part)
        remedy = f"; {self.remedy}" if self.remedy else ""
        return f"{place}{subject}{' ' if subject else ''}{self.rule}{remedy}"


class RunError(Exception):
    """A run that stopped before its end time: who, where, when and why, as one sentence."""


def show(value: Any) -> str:
    """Return a value as it would stand in a case file, at most 60 characters."""
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError):
        text = str(value)
    text = " ".join(text.split())
    return text if len(text) <= 60 else text[:57] + "..."


def key_text(path: Path) -> str:
    """Return a path as a key: `("body", "left", "velocity", 1)` is `body.left.velocity[1]`."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            bare = part.replace("_", "").replace("-", "").isalnum() and part.isascii()
            text += ("." if text else "") + (part if bare else json.dumps(part, ensure_ascii=False))
    return text


def nearest(word: str, known: Iterable[str]) -> str:
    """Return a remedy that names the nearest known word, or lists them all.

    Args:
        word: what the user wrote.
        known: the words that are valid there.
    """
    words = [str(name) for name in known]
    close = difflib.get_close_matches(word.lower(), [name.lower() for name in words], 1, 0.5)
    listing = ", ".join(words)
    if close:
        best = next(name for name in words if name.lower() == close[0])
        return f'did you mean "{best}"? (valid here: {listing})'
    return f"valid here: {listing}" if words else "nothing is valid here yet"


def violation(
    rule: str, remedy: str = "", *, value: Any = NO_VALUE, path: Path = ()
) -> PydanticCustomError:
    """Return the exception by which a validator reports a broken rule.

    Args:
        rule: what must hold.
        remedy: what the user can do.
        value: the value at fault; by default the input that pydantic was looking at.
        path: where it stands below the place that pydantic reports.
    """
    from pydantic_core import PydanticCustomError

    context = {"rule": rule, "remedy": remedy, "value": value, "path": path}
    return PydanticCustomError(VIOLATION, "{rule}", context)


def from_validation(
    error: ValidationError, locate: Callable[[Path], str] | None = None, prefix: Path = ()
) -> CaseError:
    """Translate pydantic's report: the mistake that stands first in the case, in our words.

    Args:
        error: what pydantic raised.
        locate: gives the place (`case.toml:14`) of a path; None for a case built in Python.
        prefix: path of the object that was validated.
    """
    found = [_translate(dict(item), prefix) for item in error.errors(include_url=False)]
    if locate is None:
        path, rule, remedy, value = found[0]
        return CaseError(rule, remedy, key=key_text(path), value=value)

    def line(item: tuple[Path, str, str, Any]) -> int:
        tail = locate(item[0]).rpartition(":")[2]
        return int(tail) if tail.isdigit() else 0

    path, rule, remedy, value = min(found, key=line)
    return CaseError(rule, remedy, key=key_text(path), place=locate(path), value=value)


def _translate(item: dict[str, Any], prefix: Path) -> tuple[Path, str, str, Any]:
    """Return (path, rule, remedy, value) of one of pydantic's reports."""
    path: Path = prefix + tuple(item["loc"])
    kind, context = item["type"], item.get("ctx", {})
    if kind == VIOLATION:
        value = context["value"]
        if value is NO_VALUE and not context["path"] and not isinstance(item["input"], dict):
            value = item["input"]
        return path + tuple(context["path"]), context["rule"], context["remedy"], value
    if kind == "missing":
        return path, "is missing", "add this key", NO_VALUE
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return path, "must be a table", "write it as { key = value, ... }", item["input"]
    if kind == "list_type" and isinstance(item["input"], dict):
        return path, "must be a list of tables", f"write [[{key_text(path)}]]", NO_VALUE
    if kind in ("list_type", "tuple_type"):
        return path, "must be a list", "write it as [first, second, ...]", item["input"]
    if kind == "extra_forbidden":
        return path, "is not a known key", "remove it", NO_VALUE
    if kind == "string_type":
        return path, "must be text", "write it between quotation marks", item["input"]
    return path, "is not valid here", "see the reference page of the case file", item["input"]


def from_violation(error: Exception) -> CaseError:
    """Return the `CaseError` of a violation that was raised outside pydantic; else the error."""
    context: dict[str, Any] = getattr(error, "context", None) or {}
    if "rule" not in context:
        raise error
    key = key_text(context["path"])
    return CaseError(context["rule"], context["remedy"], key=key, value=context["value"])
