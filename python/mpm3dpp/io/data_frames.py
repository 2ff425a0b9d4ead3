# SPDX-License-Identifier: BSD-3-Clause
"""Arrays by name as tables of pandas, which need not be installed."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from typing import Any

import numpy as np

from mpm3dpp.base.errors import CaseError

from .rows import component_words


def has_pandas() -> bool:
    """Return whether pandas is installed."""
    return importlib.util.find_spec("pandas") is not None


def columns_of(arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return arrays of shape (n,) by name: of one of shape (n, c) one for each component.

    They are called `NAME_x` to `NAME_z` and `NAME_xx` to `NAME_xy`, others `NAME_0` and so on.
    """
    found = {}
    for name, values in arrays.items():
        if values.ndim == 1:
            found[name] = values
            continue
        words = component_words(values.shape[1])
        found |= {f"{name}_{word}": values[:, k] for k, word in enumerate(words)}
    return found


def data_frame(arrays: Mapping[str, np.ndarray]) -> Any:
    """Return a `pandas.DataFrame` with a column for each component of arrays with as many rows.

    Raises:
        CaseError: pandas is not installed.
    """
    try:
        import pandas
    except ImportError as error:
        raise CaseError("this needs pandas", "install it: pip install pandas") from error
    return pandas.DataFrame(columns_of(arrays))


def maybe_frame(arrays: dict[str, np.ndarray]) -> Any:
    """Return a `pandas.DataFrame` of the arrays where pandas is installed, else them."""
    return data_frame(arrays) if has_pandas() else arrays
