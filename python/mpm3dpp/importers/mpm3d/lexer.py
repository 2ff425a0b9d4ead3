# SPDX-License-Identifier: BSD-3-Clause
"""Words and numbers of an `.mpm` file.

Blanks, tabs and commas part words, `!` begins a comment, line ends part nothing: values may go on
in the next line, and several statements may share one.
"""

from __future__ import annotations

import re
from collections.abc import Container
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.other_programs import mistaken_file
from mpm3dpp.base.reading import read_file
from mpm3dpp.case.file import similar_file

from .problems import Problems

_SPLIT = re.compile(r"[^\s,]+")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")
_ODD = re.compile(r"\+|-?\.")  # Begins a number that MPM3D-F90 does not read as one.
_MOST_BYTES = 64 << 20  # More than a million particles; each word becomes some 20 times as large.
_LINE, _WORDS, _LETTERS = 256, 15, 20  # What MPM3D-F90 reads of a line, and of a word.


class Word(NamedTuple):
    """A word and the line in which it stands, from 1."""

    text: str
    line: int

    @property
    def key(self) -> str:
        """The four letters that count of a keyword."""
        return self.text[:4].lower()


@dataclass
class Source:
    """The words of a file.

    Attributes:
        name: of the file, for messages.
        words: all of them.
        comments: the text of all comments.
        notes: sentences about what MPM3D-F90 would have read otherwise.
        problems: its mistakes so far.
    """

    name: str
    words: list[Word]
    comments: list[str]
    notes: list[str]
    problems: Problems = field(init=False)

    def __post_init__(self) -> None:
        self.problems = Problems(self.name)

    def error(self, rule: str, remedy: str, line: int, key: str = "") -> CaseError:
        """Return the mistake that a rule is broken at a line."""
        return CaseError(rule, remedy, key=key, place=f"{self.name}:{line}")


def read_source(path: Path) -> Source:
    """Read a file.

    Raises:
        CaseError: there is no such file, or it cannot be read.
    """
    name = str(path)
    try:
        data = read_file(path, _MOST_BYTES, "give the particles as a CSV file beside a case file")
        if other := mistaken_file(data):
            raise other
    except FileNotFoundError:
        raise CaseError("there is no such file", similar_file(path), place=name) from None
    except CaseError as error:
        raise CaseError(error.rule, error.remedy, place=name) from None
    if b"\0" in data:
        raise CaseError("is no text: it has NUL bytes", "check the file", place=name)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")  # Comments in any encoding: bytes that nobody reads.
    return split(text, name)


def split(text: str, name: str = "case.mpm") -> Source:
    """Return the words of a text."""
    source = Source(name, [], [], [])
    long_lines, many_words, long_words, letters = [], [], [], ""
    for number, whole in enumerate(re.split(r"\r\n|\n|\r", text), 1):
        line, mark, comment = whole.partition("!")
        if mark:
            source.comments.append(comment.strip())
        found = _SPLIT.findall(line)
        if len(line.rstrip()) > _LINE:
            long_lines.append(number)
        title = bool(found) and found[0][:4].lower() == "mpm3"
        if len(found) > _WORDS and not title:
            many_words.append(number)
        if title:
            source.words.append(Word(found[0], number))
            rest = line.partition(found[0])[2].strip()
            source.words.append(Word(rest, number))
            continue
        if any(len(word) > _LETTERS for word in found):
            long_words.append(number)
            letters = letters or max(found, key=len)
        source.words += [Word(word, number) for word in found]
    for lines, what in (
        (long_lines, f"more than {_LINE} characters"),
        (many_words, f"more than {_WORDS} words"),
        (long_words, f'a word of more than {_LETTERS} characters ("{letters}")'),
    ):
        if lines:
            more = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
            source.notes.append(
                f"line {lines[0]}{more} has {what}, of which MPM3D-F90 loses a part; all is read"
            )
    return source


class Reader:
    """Takes the words of a source one after another."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.at = 0
        self.line = source.words[0].line if source.words else 1
        self.keyword = ""
        self._odd: set[str] = set()

    def skip_to(self, keywords: Container[str], first: bool = True) -> None:
        """Go on at the next word that is one of these.

        Args:
            keywords: four letters each.
            first: only words with which a line begins.
        """
        words = self.source.words
        while self.more():
            begins = self.at == 0 or words[self.at - 1].line != words[self.at].line
            if words[self.at].key in keywords and (begins or not first):
                return
            self.at += 1

    def more(self) -> bool:
        """Are there words left?"""
        return self.at < len(self.source.words)

    def number_follows(self) -> bool:
        """Does a number follow in this line?"""
        if not self.more():
            return False
        following = self.source.words[self.at]
        return following.line == self.line and _NUMBER.fullmatch(following.text) is not None

    def word(self, what: str) -> Word:
        """Take the next word; `what` says what it should be."""
        if not self.more():
            remedy = "complete the file; its last word is endi"
            raise self.error(f"ends before {what}", remedy)
        found = self.source.words[self.at]
        self.at += 1
        self.line = found.line
        return found

    def error(self, rule: str, remedy: str = "", line: int | None = None) -> CaseError:
        """Return the mistake that a rule is broken by the statement that is being read."""
        return self.source.error(rule, remedy, line or self.line, self.keyword)

    def number(self, what: str) -> float:
        """Take a real number; D exponents are read as E."""
        text = self.word(what).text
        if _NUMBER.fullmatch(text) is None:
            raise self.error(f'has "{text}" where {what} must be', "give a number")
        if _ODD.match(text):
            self._note_odd(text)
        value = float(text.lower().replace("d", "e"))
        if not abs(value) < 1e100:
            raise self.error(f'has "{text}" for {what}', "give a number that is not so large")
        return value

    def numbers(self, *what: str) -> list[float]:
        """Take several real numbers."""
        return [self.number(name) for name in what]

    def integer(self, what: str) -> int:
        """Take a whole number; `10.0` is one too."""
        value = self.number(what)
        if value != int(value):
            raise self.error(f"has {value:g} for {what}", "give a whole number")
        return int(value)

    def switch(self) -> bool:
        """Take `on` or `off`."""
        word = self.word("on or off")
        if word.text.lower() not in ("on", "off"):
            raise self.error(f'has "{word.text}" where on or off must be', "write on or off")
        return word.text.lower() == "on"

    def _note_odd(self, text: str) -> None:
        if text not in self._odd and len(self._odd) < 3:
            self._odd.add(text)
            self.source.notes.append(
                f'line {self.line}: "{text}" is read as a number; MPM3D-F90, which wants a digit '
                "or - first, uses an undefined value"
            )
