# SPDX-License-Identifier: BSD-3-Clause
"""Images whose edges are smooth, of finer ones."""

from __future__ import annotations

import numpy as np


def coarser(image: np.ndarray, finer: int) -> np.ndarray:
    """Pixels that are the means of finer ones, as much of each as is covered."""
    if finer == 1:
        return image
    height, width = image.shape[0] // finer, image.shape[1] // finer
    parts = image.reshape(height, finer, width, finer, 4)
    cover = parts[..., 3].sum(axis=(1, 3), dtype=np.float32)
    found = np.empty((height, width, 4), dtype=np.float32)
    for k in range(3):
        found[..., k] = (parts[..., k] * (parts[..., 3] > 0)).sum(axis=(1, 3), dtype=np.float32)
    found[..., :3] *= 255.0 / np.maximum(cover, 1.0)[..., None]
    found[..., 3] = cover / finer**2
    return np.round(found).astype(np.uint8)
