# SPDX-License-Identifier: BSD-3-Clause
"""A frame as an object of PyVista, which need not be installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mpm3dpp.base.errors import CaseError

from .rows import TO_VTK, is_tensor

if TYPE_CHECKING:
    import pyvista


def point_cloud(arrays: dict[str, np.ndarray], time: float, step: int) -> pyvista.PolyData:
    """Return points with all arrays, tensors in VTK's order xx yy zz xy yz xz.

    Raises:
        CaseError: PyVista is not installed.
    """
    try:
        import pyvista
    except ImportError as error:
        raise CaseError(
            "results[k] needs PyVista: pip install pyvista, or use results.arrays(k)"
        ) from error
    cloud = pyvista.PolyData(arrays["position"])
    for name, values in arrays.items():
        if name != "position":
            cloud.point_data[name] = values[:, TO_VTK] if is_tensor(values) else values
    cloud.field_data["time"] = [time]
    cloud.field_data["step"] = [step]
    return cloud
