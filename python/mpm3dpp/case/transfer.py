# SPDX-License-Identifier: BSD-3-Clause
"""The transfer of a case: a word, or a table of the word with its numbers."""

from __future__ import annotations

from typing import Any

from pydantic import PrivateAttr, model_validator

from mpm3dpp import _core
from mpm3dpp.base.errors import nearest, report, violation
from mpm3dpp.base.settings import core_table

_Transfer: Any = core_table("run.transfer")
_GOES_WITH = {
    "pic_rate": "shares",
    "every": "filters",
}  # Key -> the property of the transfers that it goes with.
_OF_GASES = "aflip_of_gases"  # Where `aflip` is given and smaller, that.
_NUMBER_OF = {_OF_GASES: "aflip"}  # A further number -> its word.
_FORM = "for example { aflip = 0.97 }"


class Transfer(_Transfer):
    """How particles take the velocity of the grid.

    A word, `transfer = "apic"`, or a table of a word with its number and what goes with it,
    `{ flip = 1.0, pic_rate = "200 1/s" }` or `{ xpic = 4, every = 10 }`.
    Equations: docs/theory/step.md, transfers.
    """

    _word: str = PrivateAttr()

    @property
    def word(self) -> str:
        """The transfer's name, such as "flip"."""
        return self._word

    @model_validator(mode="wrap")
    @classmethod
    def _of_one_word(cls, given: Any, handler: Any) -> Any:
        if isinstance(given, cls):  # An assignment to one of its keys.
            return cls._checked(handler(given))
        table = given if isinstance(given, dict) else {}
        named = [key for key in table if key in _core.transfers]
        if not isinstance(given, str | dict) or (isinstance(given, dict) and len(named) != 1):
            raise violation("must be a word, or a table of one word with its number", _FORM)
        word = named[0] if named else str(given)
        if word not in _core.transfers:
            raise violation("is not a known choice", nearest(word, _core.transfers), value=word)
        if named and word not in cls.model_fields:
            remedy = f'write transfer = "{word}"'
            raise violation("has no number", remedy, value=table[word], path=(word,))
        made = handler(table)
        made._word = word
        if "aflip" in table and _OF_GASES not in table:
            made.aflip_of_gases = min(made.aflip_of_gases, made.aflip)
        return cls._checked(made)

    @classmethod
    def _checked(cls, made: Transfer) -> Transfer:
        """Return it if all its keys go with its word."""
        found = []
        for key, field in cls.model_fields.items():
            value = getattr(made, key)
            if value == field.default or made.word in (key, _NUMBER_OF.get(key)):
                continue
            if key not in _GOES_WITH:
                rule, remedy = f"is of another transfer than {made.word}", f"remove {key}"
                found.append(violation(rule, remedy, value=value, path=(key,)))
            elif not _core.transfers[made.word][_GOES_WITH[key]]:
                known = [name for name, row in _core.transfers.items() if row[_GOES_WITH[key]]]
                rule = f"goes with {' and '.join(known)}, and not with {made.word}"
                found.append(violation(rule, f"remove {key}", value=value, path=(key,)))
        report(found)
        return made

    def table(self) -> Any:
        """Return it as a value of a case file: the word alone where it has no numbers."""
        names = type(self).model_fields
        numbers = {key: getattr(self, key) for key in names}
        given = {key: value for key, value in numbers.items() if value != names[key].default}
        return {self.word: numbers[self.word]} | given if given else self.word


class WordOrTable:
    """Annotation of the field: what a case file has for it, for its JSON schema."""

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        word = {"type": "string", "enum": list(_core.transfers)}
        return {"anyOf": [word, handler(schema)]}
