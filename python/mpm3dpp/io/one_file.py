# SPDX-License-Identifier: BSD-3-Clause
"""Results of earlier versions, which have put all frames into one file."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .frame_file import damaged
from .open_h5 import own

if TYPE_CHECKING:
    import h5py


def arrays_of_one_file(
    root: h5py.Group, frame: int, names: Collection[str] | None
) -> dict[str, np.ndarray]:
    """Return arrays of a frame, as stored; all if `names` is None.

    Raises:
        CaseError: they are not there as they were written.
    """
    try:
        return _arrays(root, frame, names)
    except (OSError, LookupError, TypeError, ValueError, RuntimeError, AttributeError) as error:
        raise damaged(Path(root.file.filename), frame) from error


def _arrays(root: h5py.Group, frame: int, names: Collection[str] | None) -> dict[str, np.ndarray]:
    steps = root["Steps"]
    part = int(steps["PartOffsets"][frame])
    count = int(root["NumberOfPoints"][part])
    first = int(steps["PointOffsets"][frame])
    arrays = {"position": own(root["Points"])[first : first + count]}
    for name, data in root["PointData"].items():
        if names is not None and name not in names:
            continue
        first = int(steps["PointDataOffsets"][name][frame])
        arrays[name] = own(data)[first : first + count]
    return arrays
