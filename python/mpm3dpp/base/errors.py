# SPDX-License-Identifier: BSD-3-Clause
"""What the program says when something is wrong: one sentence, never a traceback.

`CaseError` is a mistake of the user (exit code 2), `RunError` a run that had to stop (exit code 1).
"""

from __future__ import annotations

import difflib
import itertools
import json
import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic_core import PydanticCustomError

Path = tuple[str | int, ...]
NO_VALUE: Any = object()
VIOLATION = "case_rule"
MISSING = "is missing"


class CaseError(Exception):
    """A mistake in a case, as one sentence.

    Attributes:
        key: the key at fault, written as in the case file, for example `body.left.velocity[1]`.
        place: where it stands, for example `case.toml:14`; empty for a case built in Python.
        rule: what must hold, for example `must be > 0`.
        remedy: what the user can do about it.
        value: the value given, where there is one.
        others: the other mistakes that were found with it.
    """

    others: tuple[CaseError, ...] = ()

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
        return printable(f"{place}{subject}{' ' if subject else ''}{self.rule}{remedy}")


def first_of(errors: Iterable[CaseError]) -> CaseError:
    """Return the first of some mistakes, at least one, which has the rest as its `others`."""
    unique = {mistake.sentence(): mistake for error in errors for mistake in (error, *error.others)}
    first, *others = unique.values()
    first.others = tuple(others)
    return first


class RunError(Exception):
    """A run that stopped before its end time: who, where, when and why, as one sentence."""


def show(value: Any) -> str:
    """Return a value as it would stand in a case file, at most 60 characters."""
    value = _shortened(value)
    if isinstance(value, _Words):
        return value
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError):
        text = str(value)
    text = printable(" ".join(text[:200].split()))
    return text if len(text) <= 60 else text[:57] + "..."


class _Words(str):
    """What is said of a value that is too long to be shown; without quotation marks."""


def printable(text: str) -> str:
    """Return text without characters that a terminal would act on, or cannot show."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def _shortened(value: Any, depth: int = 3) -> Any:
    """Return a value of which what is shown is there, and little more: it may be of any size."""
    if isinstance(value, str):
        return value if isinstance(value, _Words) else value[:100]
    if isinstance(value, int) and value.bit_length() > 200:
        return _Words(f"a number of {value.bit_length() * math.log10(2):.0f} digits")
    if isinstance(value, dict):
        some = itertools.islice(value.items(), 30)
        return {k: _shortened(v, depth - 1) for k, v in some} if depth else "..."
    if isinstance(value, list | tuple):
        return [_shortened(item, depth - 1) for item in value[:30]] if depth else "..."
    return value


def key_text(path: Path) -> str:
    """Return a path as a key: `("body", "left", "velocity", 1)` is `body.left.velocity[1]`."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            bare = part.replace("_", "").replace("-", "").isalnum() and part.isascii()
            text += ("." if text else "") + (part if bare and len(part) <= 60 else show(part))
    return text if len(text) <= 200 else f"{text[:100]} ... {text[-90:]}"


def nearest(word: str, known: Iterable[str]) -> str:
    """Return a remedy that names the nearest known word, or lists them all.

    Args:
        word: what the user wrote.
        known: the words that are valid there.
    """
    words = [str(name) for name in known]
    listing = ", ".join(words)
    if guess := guessed(word, words):
        return f"{guess} (valid here: {listing})"
    return f"valid here: {listing}" if words else "nothing is valid here yet"


def guessed(word: str, known: Iterable[str]) -> str:
    """Return the question whether the nearest known word was meant; empty if none is near."""
    words = list(known)
    lower = [name.lower() for name in words]
    # What somebody shortens is a part of the word: "bspline" means "quadratic_bspline".
    close = [name for name in lower if len(word) > 2 and word.lower() in name]
    close = close or difflib.get_close_matches(word.lower(), lower, 1, 0.5)
    return f'did you mean "{words[lower.index(close[0])]}"?' if close else ""


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

    value = _shortened(value)  # pydantic makes text of it; Python refuses thousands of digits.
    if isinstance(value, str) and not value.isprintable():
        value = _Words(printable(json.dumps(value[:100], ensure_ascii=False)))
    rule, remedy = printable(rule), printable(remedy)
    path = tuple(part if isinstance(part, int) else printable(part) for part in path)
    context = {"rule": rule, "remedy": remedy, "value": value, "path": path}
    return PydanticCustomError(VIOLATION, "{rule}", context)


def report(found: Iterable[Exception]) -> None:
    """Raise the violations that a validator has found, all of them; none if there are none.

    Raises:
        PydanticCustomError: the one violation.
        ValidationError: several, which pydantic takes over into its report.
    """
    from pydantic_core import InitErrorDetails, ValidationError

    found = list(found)
    if len(found) == 1:
        raise found[0]
    if found:
        details = [InitErrorDetails(type=v, loc=(), input={}) for v in found]  # type: ignore
        raise ValidationError.from_exception_data("case", details)


def violations_of(error: Exception) -> list[dict[str, Any]]:
    """Return rule, remedy, value and path of each violation in what a validator raised."""
    if hasattr(error, "errors"):
        keys = ("path", "rule", "remedy", "value")
        items = error.errors(include_url=False)
        return [dict(zip(keys, _translate(dict(item), ()), strict=True)) for item in items]
    context: dict[str, Any] = getattr(error, "context", None) or {}
    if "rule" not in context:
        raise error
    return [context]


def below(error: Exception, path: Path, value: Any = NO_VALUE) -> list[PydanticCustomError]:
    """Return the violations of a part as those of the whole: with the part's path before theirs.

    Args:
        error: what the part's validator raised.
        path: of the part.
        value: shown in place of theirs.
    """
    return [
        violation(
            found["rule"],
            found["remedy"],
            value=found["value"] if value is NO_VALUE else value,
            path=(*path, *found["path"]),
        )
        for found in violations_of(error)
    ]


def from_validation(
    error: ValidationError, locate: Callable[[Path], str] | None = None, prefix: Path = ()
) -> CaseError:
    """Translate pydantic's report in our words: the mistake that stands first in the case.

    The others are its `others`, in the order of the case.

    Args:
        error: what pydantic raised.
        locate: gives the place (`case.toml:14`) of a path; None for a case built in Python.
        prefix: path of the object that was validated.
    """
    found = [_translate(dict(item), prefix) for item in error.errors(include_url=False)]

    def line(item: tuple[Path, str, str, Any]) -> int:
        tail = locate(item[0]).rpartition(":")[2] if locate is not None else ""
        return int(tail) if tail.isdigit() else 0

    return first_of(
        CaseError(
            rule,
            remedy,
            key=key_text(path),
            place="" if locate is None else locate(path),
            value=value,
        )
        for path, rule, remedy, value in sorted(found, key=line)
    )


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
        return path, MISSING, "add this key", NO_VALUE
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


def from_violation(error: Exception, locate: Callable[[Path], str] | None = None) -> CaseError:
    """Return the `CaseError` of violations that were raised outside pydantic.

    Another error is raised as it is.
    """
    return first_of(
        CaseError(
            found["rule"],
            found["remedy"],
            key=key_text(found["path"]),
            place="" if locate is None else locate(found["path"]),
            value=found["value"],
        )
        for found in violations_of(error)
    )
