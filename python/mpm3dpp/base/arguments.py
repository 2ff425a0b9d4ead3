# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of functions that users call: a wrong one is refused in a sentence that names it.

Every function returns the argument as the type that is wanted, or raises `CaseError`.
"""

from __future__ import annotations

import operator
import os
from pathlib import Path
from typing import Any

import numpy as np

from .errors import CaseError
from .units import to_si


def whole_number(name: str, value: Any, least: int | None = None, most: int | None = None) -> int:
    """Return a whole number from `least` to `most`."""
    give = f"give a whole number such as {least or 1}"
    try:
        number = operator.index(value)
    except TypeError:
        raise CaseError("must be a whole number", give, key=name, value=value) from None
    if isinstance(value, bool):
        raise CaseError("must be a whole number", give, key=name, value=value)
    if least is not None and number < least:
        raise CaseError(f"must be >= {least}", give, key=name, value=value)
    if most is not None and number > most:
        raise CaseError(f"must be <= {most}", give, key=name, value=value)
    return number


def quantity(name: str, value: Any, unit: str) -> float:
    """Return a quantity in the SI unit given; it may be text with another."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    try:
        return to_si(value, unit)
    except CaseError as error:
        raise CaseError(error.rule, error.remedy, key=name, value=value) from None


def finite_numbers(name: str, value: Any, shape: tuple[int, ...], rows: str) -> np.ndarray:
    """Return finite numbers of a shape (n, D); `rows` says what there is one for."""
    try:
        found = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        found = np.array(np.nan)
    if found.shape != shape or not np.isfinite(found).all():
        remedy = f"give an array of the shape {shape}, {rows}"
        raise CaseError("must be finite numbers, shape (n, D)", remedy, key=name)
    return np.ascontiguousarray(found)


def place(name: str, value: Any, dimension: int) -> np.ndarray:
    """Return a place [m], shape (D,); its numbers may be text with a unit."""
    if isinstance(value, str) or not hasattr(value, "__len__") or len(value) != dimension:
        raise CaseError(f"must have {dimension} numbers", "give a place [m]", key=name, value=value)
    return np.array([quantity(name, number, "m") for number in value])


def text(name: str, value: Any) -> str:
    """Return text."""
    if not isinstance(value, str):
        raise CaseError("must be text", "write a name in quotation marks", key=name, value=value)
    return value


def texts(name: str, value: Any) -> list[str]:
    """Return a list of text."""
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        raise CaseError("must be a list of names", 'write ["ball"]', key=name, value=value)
    return [text(name, one) for one in value]


def path(name: str, value: Any) -> Path:
    """Return the path of a file or folder."""
    try:
        found = os.fspath(value)
    except TypeError:
        found = ""
    if not isinstance(found, str) or not found or "\0" in found:
        remedy = 'give text such as "results/rings", or a pathlib.Path'
        raise CaseError("must be the path of a file or folder", remedy, key=name, value=value)
    return Path(found)
