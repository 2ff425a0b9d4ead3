# SPDX-License-Identifier: BSD-3-Clause
"""Conditions on the particles of a frame, as users write them: `body=plate, pressure > 1 MPa`."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, nearest

_COMPARE: dict[str, Callable[[Any, Any], Any]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "!=": operator.ne,
    "=": operator.eq,
    "<": operator.lt,
    ">": operator.gt,
}
_CONDITION = re.compile(r"\s*(\w+)\s*(<=|>=|!=|==|=|<|>)\s*(.+?)\s*")


def chosen(
    where: str,
    columns: Mapping[str, np.ndarray],
    words: Mapping[str, Sequence[str]],
    units: Mapping[str, str],
) -> NDArray[np.bool_]:
    """Return which particles fulfil conditions, all of them, shape (n,).

    Args:
        where: conditions, `NAME OPERATOR VALUE`, with commas between.
        columns: name -> (n,).
        words: of columns that count names, these: {"body": ["ball", "plate"]}.
        units: of columns, in which a value without unit is.

    Raises:
        CaseError: it cannot be read, or there is no such column or name.
    """
    found = np.ones(len(next(iter(columns.values()))), dtype=bool)
    for condition in where.split(","):
        match = _CONDITION.fullmatch(condition)
        if match is None:
            remedy = "write such as body=plate, or pressure > 1 MPa, with commas between several"
            raise CaseError("is no condition", remedy, key="where", value=condition)
        name, sign, text = match.groups()
        if name not in columns:
            raise CaseError("is no column", nearest(name, columns), key="where", value=name)
        value: float
        if name in words and not text.lstrip("-").isdigit():
            if text not in words[name]:
                rule = f"is no {name} of these results"
                raise CaseError(rule, nearest(text, words[name]), key="where", value=text)
            value = words[name].index(text)
        else:
            value = _number(text, units.get(name, ""))
        found &= _COMPARE["=" if sign == "==" else sign](columns[name].astype(float), value)
    return found


def _number(text: str, unit: str) -> float:
    try:
        return float(text)
    except ValueError:
        return arguments.quantity("where", text, unit)
