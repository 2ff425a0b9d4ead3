# SPDX-License-Identifier: BSD-3-Clause
"""Which runs a sweep makes: every combination of the values of its keys."""

from __future__ import annotations

import hashlib
import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.case import Case
from mpm3dpp.case.changes import assignment, path_of, value_of, values_of, with_changes

_MOST = 10_000  # runs
_LONGEST = 80  # Letters of the name of a folder, before such digits.


@dataclass(frozen=True)
class Planned:
    """A run of a sweep.

    Attributes:
        values: of each key that is swept, as the user wrote it.
        case: with these values.
        folder: of its results.
    """

    values: dict[str, str]
    case: Case
    folder: Path

    def words(self) -> str:
        """Return what is changed, as `contact.friction = 0.2`."""
        return ", ".join(f"{key} = {value}" for key, value in self.values.items())


def plan_of(case: Case, sweeps: Sequence[str], out: Path) -> list[Planned]:
    """Return the runs of a sweep, the last key changing fastest; every case is checked.

    Args:
        case: of a file.
        sweeps: `KEY=VALUE,VALUE,...`, each key once; `KEY=` takes it out.
        out: the folder, of which each run gets a folder.

    Raises:
        CaseError: there is nothing to change, or a case breaks a rule.
    """
    lists: dict[str, list[str]] = {}
    for text in sweeps:
        key, values = assignment(text)
        if key in lists:
            raise CaseError("is given twice", "give all values in one list", key=key)
        lists[key] = values_of(values)
        if len(set(lists[key])) < len(lists[key]) or "" in lists[key][1:]:
            rule = "must have different values"
            raise CaseError(rule, "write KEY=VALUE,VALUE", key=key, value=values)
    if not lists:
        raise CaseError("there is nothing to change", "give --set contact.friction=0,0.1,0.2")
    found = list(itertools.product(*lists.values()))
    if len(found) > _MOST:
        raise CaseError(f"{len(found):,} runs are more than {_MOST:,}", "give fewer values")
    plan = []
    for combination in found:
        given = dict(zip(lists, combination, strict=True))
        changes = {path_of(key): value_of(value) if value else None for key, value in given.items()}
        plan.append(Planned(given, with_changes(case, changes), out / _folder(given)))
    return plan


def _folder(values: dict[str, str]) -> str:
    """Return a name that says keys and values, so that others have other folders.

    Where not all of it can be in a name, some digits stand for the rest.
    """
    whole = ",".join(f"{key}={value}" for key, value in values.items())
    name = re.sub(r"[^\w.=+,-]+", "_", whole)[:_LONGEST].strip("_")
    if name == whole.replace(" ", "_"):
        return name
    return f"{name}_{hashlib.sha256(whole.encode()).hexdigest()[:6]}"
