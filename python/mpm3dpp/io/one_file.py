# SPDX-License-Identifier: BSD-3-Clause
"""Results of earlier versions, which have put all frames into one file."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import h5py


def arrays_of_one_file(
    root: h5py.Group, frame: int, names: Collection[str] | None
) -> dict[str, np.ndarray]:
    """Return arrays of a frame, as stored; all if `names` is None."""
    steps = root["Steps"]
    part = int(steps["PartOffsets"][frame])
    count = int(root["NumberOfPoints"][part])
    first = int(steps["PointOffsets"][frame])
    arrays = {"position": root["Points"][first : first + count]}
    for name, data in root["PointData"].items():
        if names is not None and name not in names:
            continue
        first = int(steps["PointDataOffsets"][name][frame])
        arrays[name] = data[first : first + count]
    return arrays
