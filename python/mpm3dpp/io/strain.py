# SPDX-License-Identifier: BSD-3-Clause
"""Strains of a frame, from where particles stand in it and stood in the first one.

The deformation gradient of a particle is that of the linear field nearest to the displacements
around it, by weighted least squares: F = (sum w dx dX^T) (sum w dX dX^T)^-1 over its neighbours at
the start, exact where the motion is linear, rotations included. The strain is Hencky's (1928),
1/2 ln(F F^T), whose axes are those of the present place.
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray
_REACH = 1.8  # spacings of a neighbour, so that all of a square or cube of 3 are
_CHUNK = 1 << 17  # particles at once
_FLAT = 1e-6  # least share of spread along an axis for which there is a gradient


def hencky_strain(start: Array, present: Array, size: Array, body: Array) -> Array:
    """Return the logarithmic strain of each particle.

    Args:
        start, present: where it stood and stands [m], shape (n, D).
        size: its edge at the start [m], shape (n,).
        body: number of the body that it belongs to, shape (n,).

    Returns:
        Shape (n, 6), xx yy zz yz xz xy; in 2D zz, yz and xz are 0. NaN where its neighbours stand
        on a line or in a plane.
    """
    strain = np.full((len(start), 6), np.nan)
    order = np.argsort(body, kind="stable")
    for of_body in np.split(order, np.flatnonzero(np.diff(body[order])) + 1):
        strain[of_body] = _of_body(start[of_body], present[of_body], size[of_body])
    return strain


def _of_body(start: Array, present: Array, size: Array) -> Array:
    from scipy.spatial import cKDTree

    D, count = start.shape[1], min(3 ** start.shape[1], len(start))
    tree, strain = cKDTree(start), np.full((len(start), 6), np.nan)
    for first in range(0, len(start) if count > D else 0, _CHUNK):
        rows = slice(first, first + _CHUNK)
        away, near = tree.query(start[rows], k=count)
        share = np.clip(1.0 - away / (_REACH * size[rows, None]), 0.0, None) ** 2
        before = start[near] - start[rows, None]
        after = present[near] - present[rows, None]
        spread = np.einsum("nk,nki,nkj->nij", share, before, before)
        least = np.linalg.eigvalsh(spread)
        good = least[:, 0] > _FLAT * least[:, -1]
        moved = np.einsum("nk,nki,nkj->nij", share, after, before)[good]
        gradient = np.swapaxes(np.linalg.solve(spread[good], np.swapaxes(moved, 1, 2)), 1, 2)
        found = np.full((len(good), 6), np.nan)
        found[good] = _hencky(gradient)
        strain[rows] = found
    return strain


def _hencky(gradient: Array) -> Array:
    """Return 1/2 ln(F F^T) of gradients (n, D, D), shape (n, 6)."""
    squares, axes = np.linalg.eigh(gradient @ np.swapaxes(gradient, 1, 2))
    logs = 0.5 * np.log(np.where(squares > 0.0, squares, np.nan))  # NaN where all is in a plane
    tensor = np.einsum("nik,nk,njk->nij", axes, logs, axes)
    found = np.zeros((len(tensor), 6))
    for k, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))):
        if j < tensor.shape[1]:
            found[:, k] = tensor[:, i, j]
    return found
