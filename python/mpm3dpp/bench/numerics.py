# SPDX-License-Identifier: BSD-3-Clause
"""The numerics of a benchmark: those of a case that says nothing of them, or what is said."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from mpm3dpp.base.errors import CaseError, key_text
from mpm3dpp.base.model import plain
from mpm3dpp.case.case import Case

_PATHS = {
    "basis": ("grid", "basis"),
    "transfer": ("run", "transfer"),
    "scheme": ("run", "scheme"),
    "preset": ("preset",),
}


class Numerics(NamedTuple):
    """What is said of them, by the words of a case file; None where nothing is.

    Attributes:
        basis: `grid.basis`.
        transfer: `run.transfer`.
        scheme: `run.scheme`.
        preset: `preset`.
    """

    basis: str | None = None
    transfer: str | None = None
    scheme: str | None = None
    preset: str | None = None

    @classmethod
    def of_words(cls, words: Iterable[str]) -> Numerics:
        """Return those of words such as "basis=gimp"."""
        return cls(**dict(word.split("=", 1) for word in words))

    def words(self) -> list[str]:
        """Return what is said as words such as "basis=gimp"."""
        return [f"{name}={value}" for name, value in self._asdict().items() if value is not None]


DEFAULT = Numerics()
"""What a case file has that has no word of numerics."""


def case_of(tables: dict[str, Any], numerics: Numerics) -> Case:
    """Return the case of tables that say nothing of numerics, with these.

    Raises:
        CaseError: of the word that is wrong, by its name here.
    """
    whole = {key: dict(table) for key, table in tables.items()}
    for name, value in numerics._asdict().items():
        if value is None:
            continue
        *above, key = _PATHS[name]
        (whole[above[0]] if above else whole)[key] = value
    try:
        return Case.from_tables(whole, "", {})
    except CaseError as error:
        names = {key_text(path): name for name, path in _PATHS.items()}
        if error.key not in names:
            raise
        rule, remedy = error.rule, error.remedy
        raise CaseError(rule, remedy, key=names[error.key], value=error.value) from None


def words_of(case: Case) -> dict[str, Any]:
    """Return basis, transfer, scheme and preset of a case, as a result names them."""
    return {
        "basis": case.grid.basis,
        "transfer": plain(case.run.transfer),
        "scheme": case.run.scheme,
        "preset": case.preset,
    }
