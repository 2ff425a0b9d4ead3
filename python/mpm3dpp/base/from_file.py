# SPDX-License-Identifier: BSD-3-Clause
"""Values of a case that are files beside it: their names, and the unit of their lengths."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from .errors import CaseError, nearest, violation
from .units import to_si


class FromFile:
    """Annotation of a field of a case: an object, or the name of a file beside the case file.

    A table `{ file = "points.csv", unit = "mm" }` names the unit of its lengths too.

    Args:
        kind: the object's class.
        read: makes one of a path, a name for messages, and the unit of lengths.
        what: it is, for messages.
        example: a name of a file.
    """

    def __init__(
        self, kind: type, read: Callable[[Path, str, str], Any], what: str, example: str
    ) -> None:
        self.kind, self.read, self.what, self.example = kind, read, what, example

    def parse(self, value: Any, info: Any) -> Any:
        """Return the object, or raise the violation that pydantic collects."""
        if value is None or isinstance(value, self.kind):
            return value
        name, unit = self._of_table(value) if isinstance(value, dict) else (value, "m")
        if not isinstance(name, str):
            rule = f"must be the name of a file of {self.what}"
            raise violation(rule, f'for example "{self.example}"', value=value)
        folder = Path((info.context or {}).get("folder", "."))
        try:
            return self.read(folder / name, name, unit)
        except CaseError as error:
            raise violation(error.rule, error.remedy, value=name) from None

    def _of_table(self, table: dict[str, Any]) -> tuple[Any, str]:
        """Return the name of the file and the unit of lengths that a table gives."""
        for key in table:
            if key not in ("file", "unit"):
                remedy = nearest(str(key), ("file", "unit"))
                raise violation("is not a known key", remedy, path=(str(key),))
        if "file" not in table:
            raise violation("is missing", f'add file = "{self.example}"', path=("file",))
        unit = table.get("unit", "m")
        remedy = 'give a unit of length such as "mm"'
        if not isinstance(unit, str):
            raise violation("must be text", remedy, value=unit, path=("unit",))
        try:
            to_si(f"1 {unit}", "m")
        except CaseError:
            raise violation("is no unit of length", remedy, value=unit, path=("unit",)) from None
        return table["file"], unit

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.with_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        text = {"type": "string"}
        table = {
            "type": "object",
            "additionalProperties": False,
            "required": ["file"],
            "properties": {"file": text, "unit": text},
        }
        return {"anyOf": [text, table]}


def file_entry(file: str, unit: str) -> str | dict[str, str]:
    """Return what a case file says of a file of points: its name, with the unit if not metres."""
    return file if unit == "m" else {"file": file, "unit": unit}
