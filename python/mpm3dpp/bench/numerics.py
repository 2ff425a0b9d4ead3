# SPDX-License-Identifier: BSD-3-Clause
"""The numerics of a benchmark: those of a case that says nothing of them, or what is said."""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce
from operator import getitem
from typing import Any, NamedTuple

from mpm3dpp.base.errors import CaseError, key_text
from mpm3dpp.base.model import plain
from mpm3dpp.case.case import Case

CELL = 1e-3
"""Size of the cells of all benchmarks [m]."""
PER_AXIS = 2
"""Particles of a cell along each axis, but where a frame has more by default."""


class Numerics(NamedTuple):
    """What is said of them, by the words of a case file; None where nothing is.

    Attributes:
        basis: `grid.basis`.
        transfer: `run.transfer`.
        scheme: `run.scheme`.
        preset: `preset`.
        frame: `frame` of all bodies and grains that deform.
    """

    basis: str | None = None
    transfer: str | None = None
    scheme: str | None = None
    preset: str | None = None
    frame: str | None = None

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
    """Return the case of tables that say nothing of numerics, and are given these.

    Raises:
        CaseError: of the word that is wrong, by its name here.
    """
    paths: dict[str, list[tuple[str, ...]]] = {
        "basis": [("grid", "basis")],
        "transfer": [("run", "transfer")],
        "scheme": [("run", "scheme")],
        "preset": [("preset",)],
        "frame": [
            (kind, name, "frame")
            for kind in ("body", "grains")
            for name, part in tables.get(kind, {}).items()
            if "motion" not in part
        ],
    }
    for name, value in numerics._asdict().items():
        for *above, key in paths[name] if value is not None else ():
            reduce(getitem, above, tables)[key] = value
    try:
        return Case.from_tables(tables, "", {})
    except CaseError as error:
        names = {key_text(path): name for name, found in paths.items() for path in found}
        if error.key not in names:
            raise
        rule, remedy = error.rule, error.remedy
        raise CaseError(rule, remedy, key=names[error.key], value=error.value) from None


def words_of(case: Case) -> dict[str, Any]:
    """Return basis, transfer, scheme, preset and frame of a case, as a result names them."""
    deform = (part for name, part in case.parts().items() if not case.is_rigid(name))
    return {
        "basis": case.grid.basis,
        "transfer": plain(case.run.transfer),
        "scheme": case.run.scheme,
        "preset": case.preset,
        "frame": next(deform).frame,
    }
