# SPDX-License-Identifier: BSD-3-Clause
"""Reading a case file: TOML, and the line of every key for the messages."""

from __future__ import annotations

import difflib
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mpm3dpp.base import errors
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.other_programs import mistaken_file
from mpm3dpp.base.readers import SUFFIXES, reader_of
from mpm3dpp.base.reading import read_file

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

MOST_BYTES = 4 << 20
"""Of a case file: what is read, with its lines found, in some seconds."""
_DEEPEST = 300  # Tables in tables; the TOML reader itself goes not much deeper.
_MOST_FILES = 100  # Files of a folder that are looked at for a name like one that is missing.

_TOKEN = re.compile(
    r"(?P<skip>[ \t\r]+|\#[^\n]*)|(?P<line>\n)"
    r'|(?P<text>"""(?:[^\\]|\\.)*?"{3,5}|\'\'\'.*?\'{3,5}|"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\')'
    r"|(?P<mark>[\[\]{}=,.])|(?P<bare>[^\s\[\]{}=,.\"'#]+)",
    re.S,
)


class _Locator:
    """Walks the tokens of a valid TOML text and notes the line of each key and list item."""

    def __init__(self, text: str) -> None:
        self.lines: dict[errors.Path, int] = {}
        self.tokens: list[tuple[str, str, int]] = []
        line = 1
        for match in _TOKEN.finditer(text):
            if match.lastgroup != "skip":
                self.tokens.append((match.lastgroup or "", match.group(), line))
            line += match.group().count("\n")
        self.tokens.append(("end", "", line))
        self.at = 0

    def peek(self) -> str:
        return self.tokens[self.at][1]

    def skip_lines(self) -> None:
        while self.tokens[self.at][0] == "line":
            self.at += 1

    def keys(self) -> list[str]:
        """Read `a.b."c d"`."""
        keys: list[str] = []
        while True:
            kind, token, _ = self.tokens[self.at]
            keys.append(str(tomllib.loads(f"k={token}")["k"]) if kind == "text" else token)
            self.at += 1
            if self.peek() != ".":
                return keys
            self.at += 1

    def note(self, path: errors.Path) -> None:
        """Keep the present line for a path and for the tables above it not seen before."""
        if len(path) > _DEEPEST:
            raise RecursionError
        for length in range(1, len(path) + 1):
            self.lines.setdefault(path[:length], self.tokens[self.at - 1][2])

    def pair(self, table: errors.Path) -> None:
        """Read `key = value` of a table."""
        path = (*table, *self.keys())
        self.note(path)
        self.at += 1  # the "="
        self.value(path)

    def value(self, path: errors.Path) -> None:
        """Read a value, which may be an inline table or a list over several lines."""
        opening = self.peek() if self.tokens[self.at][0] == "mark" else ""
        if opening not in ("[", "{"):
            while self.tokens[self.at][0] not in ("line", "end") and self.peek() not in (
                ",",
                "]",
                "}",
            ):
                self.at += 1
            return
        self.at += 1
        index = 0
        while True:
            self.skip_lines()
            if self.peek() == ",":
                self.at += 1
            elif self.peek() in ("]", "}", ""):
                self.at += 1
                return
            elif opening == "{":
                self.pair(path)
            else:
                place = (*path, index)
                self.lines[place] = self.tokens[self.at][2]
                self.value(place)
                index += 1

    def header(self, counts: dict[errors.Path, int]) -> errors.Path:
        """Read `[table]` or `[[table]]` and return its path, with the index of list items."""
        self.at += 1
        is_list = self.peek() == "["
        self.at += is_list
        keys = self.keys()
        path: errors.Path = ()
        for depth, key in enumerate(keys):
            path = (*path, key)
            if is_list and depth == len(keys) - 1:
                counts[path] = counts.get(path, -1) + 1
            if path in counts:
                path = (*path, counts[path])
        self.note(path)
        self.at += 1 + is_list
        return path

    def run(self) -> dict[errors.Path, int]:
        table: errors.Path = ()
        counts: dict[errors.Path, int] = {}
        while self.tokens[self.at][0] != "end":
            self.skip_lines()
            if self.peek() == "[":
                table = self.header(counts)
            elif self.tokens[self.at][0] != "end":
                self.pair(table)
        return self.lines


def locate_keys(text: str, name: str = "") -> dict[errors.Path, int]:
    """Return the line of each key, table and list item of a valid TOML text, by path.

    Raises:
        CaseError: the text is nested too deeply; its place is `name`.
    """
    try:
        return _Locator(text).run()
    except RecursionError:
        raise too_deep(name) from None


CHANGED = 0
"""Line of a key whose value is not the file's."""


def locator(lines: dict[errors.Path, int], name: str) -> Callable[[errors.Path], str]:
    """Return a function that gives the place (`case.toml:14`) of a path or its nearest parent."""

    def place(path: errors.Path) -> str:
        while path and path not in lines:
            path = path[:-1]
        line = lines.get(path, 1)
        return f"{name} as changed" if line == CHANGED else f"{name}:{line}"

    return place


def read_text(path: Path) -> str:
    """Return the text of a case file.

    Raises:
        CaseError: the file is missing, no regular file, not readable, too large, not UTF-8 text, or
            one of another program.
    """
    name = str(path)
    try:
        data = read_file(path, MOST_BYTES, "put particles into a CSV file beside it")
        if other := mistaken_file(data):
            raise other
        return data.decode("utf-8-sig")
    except FileNotFoundError:
        remedy = similar_file(path)
        raise CaseError("there is no such file", remedy, place=name) from None
    except UnicodeDecodeError as error:
        remedy = "save it as UTF-8"
        raise CaseError(f"is not UTF-8 text (byte {error.start})", remedy, place=name) from None
    except CaseError as error:
        remedy = error.remedy
        if error.rule.endswith("a folder"):
            remedy = f'give the file in it, for example "{path / "case.toml"}"'
        raise CaseError(error.rule, remedy, place=name) from None


def similar_file(path: Path) -> str:
    """Return the remedy for a file that is missing: the case file with the nearest name."""
    folder = path.parent
    try:
        files = sorted(p for p in folder.iterdir() if p.suffix.lower() in (".toml", *SUFFIXES))
    except OSError:
        files = []
    stems = [p.stem.lower() for p in files]
    close = difflib.get_close_matches(path.stem.lower(), stems, _MOST_FILES, 0.6)
    # The nearest first; of equal names the first, as the folder has them sorted.
    found = (files[stems.index(stem)] for stem in close)
    case = next((file for file in found if _is_case(file)), None)
    return f'did you mean "{case}"?' if case else "check the path"


def _is_case(path: Path) -> bool:
    """Whether a file is a case file, by its table `grid`, or another program's, by its ending."""
    if reader_of(path) is not None:
        return path.is_file()
    try:
        text = read_file(path, MOST_BYTES, "").decode("utf-8-sig")
    except (OSError, UnicodeDecodeError, CaseError):
        return False
    return re.search(r"^\s*(\[\s*grid\b|grid\b.*=)", text, re.M) is not None


def parse(text: str, name: str) -> dict[str, Any]:
    """Return the tables of a TOML text.

    Args:
        text: the text of a case file.
        name: its name, for the messages.

    Raises:
        CaseError: the text is not valid TOML; the place is the line.
    """
    if any(_is_deep(line) for line in text.splitlines()):
        raise too_deep(name)
    try:
        return tomllib.loads(text.replace("\r\n", "\n"))
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(str(error), text, name) from None
    except RecursionError:
        raise too_deep(name) from None
    except ValueError:  # Python makes no number of thousands of digits.
        rule = "has a number of more digits than are read"
        raise CaseError(
            rule, "write it with an exponent, 1e30", place=_digits_at(text, name)
        ) from None


def _is_deep(line: str) -> bool:
    """Whether a line has a key `a.b.c` of so many parts that the TOML reader takes for ever."""
    if line.count(".") < _DEEPEST:
        return False
    dots = 0
    for token in _TOKEN.finditer(line):
        if token.group() == ".":
            dots += 1
        elif token.lastgroup == "mark":
            dots = 0
        if dots >= _DEEPEST:
            return True
    return False


def too_deep(name: str) -> CaseError:
    """Return the mistake that a file, by its name, has tables in tables in tables ..."""
    return CaseError("is nested too deeply", "use fewer brackets and dots", place=name)


def _digits_at(text: str, name: str) -> str:
    """Return the place of the longest row of digits of a text."""
    longest = max(re.finditer(r"[\d_]+", text), key=lambda found: len(found.group()))
    return f"{name}:{text.count(chr(10), 0, longest.start()) + 1}"


def _syntax_error(message: str, text: str, name: str) -> CaseError:
    """Translate the TOML reader's message."""
    all_lines = text.splitlines() or [""]
    found = re.search(r" \(at line (\d+), column \d+\)$", message)
    line = int(found.group(1)) if found else len(all_lines)
    shown = all_lines[min(line, len(all_lines)) - 1].strip()
    place = f"{name}:{line}"
    if "overwrite" in message or "twice" in message or "mutate" in message:
        key = shown.partition("=")[0].strip() or shown
        return CaseError("is given twice", "keep one of the two", key=key, place=place)
    reason = re.sub(r" \(at .*\)$", "", message)
    reason = reason[:1].lower() + reason[1:]
    remedy = 'write key = value, with text and units between quotation marks ("30 mm")'
    return CaseError(f"is not valid TOML: {reason}", remedy, key=shown[:60], place=place)
