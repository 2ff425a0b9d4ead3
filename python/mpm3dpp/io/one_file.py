# SPDX-License-Identifier: BSD-3-Clause
"""Results of earlier versions, which have put all frames into one file."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from mpm3dpp.base.errors import CaseError

from .open_h5 import own

if TYPE_CHECKING:
    import h5py


def arrays_of_one_file(
    root: h5py.Group, frame: int, names: Collection[str] | None
) -> dict[str, np.ndarray]:
    """Return arrays of a frame, as stored; all if `names` is None.

    Raises:
        CaseError: it cannot be read.
    """
    try:
        return _arrays(root, frame, names)
    except (OSError, KeyError, ValueError, TypeError, AttributeError, RuntimeError) as error:
        rule = f"frame {frame} of '{root.file.filename}' is damaged: it cannot be read"
        raise CaseError(rule, "use other frames") from error


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
