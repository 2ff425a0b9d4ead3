# SPDX-License-Identifier: BSD-3-Clause
"""Arrays as the files of the frames hold them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

TO_VTK = (0, 1, 2, 5, 3, 4)
"""Order of VTK's symmetric tensors (xx yy zz xy yz xz) taken from ours (xx yy zz yz xz xy)."""
FROM_VTK = (0, 1, 2, 4, 5, 3)
"""Our order taken from VTK's: where VTK has each of our components."""


def is_tensor(values: np.ndarray) -> bool:
    """Return whether an array has a symmetric tensor in each row."""
    return values.ndim == 2 and values.shape[1] == 6


_COMPONENTS = {2: ("x", "y"), 3: ("x", "y", "z"), 6: ("xx", "yy", "zz", "yz", "xz", "xy")}
GONE = 3
"""In the column `failed`: from here on a particle takes no part any more (3: eroded, 4: left)."""


def component_words(count: int) -> tuple[str, ...]:
    """Return what stands behind the name of an array for each of its components."""
    return _COMPONENTS.get(count, tuple(map(str, range(count))))


def field_of(arrays: Mapping[str, np.ndarray], name: str) -> np.ndarray | None:
    """Return an array by its name, "speed", or a component such as velocity_x or stress_xy.

    None where there is no such array.
    """
    if name in arrays:
        return arrays[name]
    if name == "speed" and "velocity" in arrays:
        return np.linalg.norm(arrays["velocity"], axis=1)
    whole, _, component = name.rpartition("_")
    if whole not in arrays or arrays[whole].ndim != 2:
        return None
    words = component_words(arrays[whole].shape[1])
    return arrays[whole][:, words.index(component)] if component in words else None


def takes_part(arrays: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return which particles of a frame take part, shape (n,); of one without `failed` all."""
    if "failed" not in arrays:
        return np.ones(len(arrays["position"]), dtype=bool)
    return ~(arrays["failed"] >= GONE)  # NaN where nothing can fail.


def as_stored(array: np.ndarray) -> np.ndarray:
    """Return as stored: float32 (integers int32), two components as three, tensors in VTK order."""
    array = np.asarray(array)
    if is_tensor(array):
        array = array[:, TO_VTK]
    if array.ndim == 2 and array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array))])
    kind = np.int32 if np.issubdtype(array.dtype, np.integer) else np.float32
    with np.errstate(over="ignore"):  # beyond float32 means a run that blew up: stored as inf
        return np.ascontiguousarray(array, dtype=kind)
