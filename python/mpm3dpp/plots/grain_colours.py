# SPDX-License-Identifier: BSD-3-Clause
"""Colours of grains: each has its own, and those that are neighbours differ."""

from __future__ import annotations

import numpy as np

from .style import PALETTE

_FEWEST = 4  # Colours that grains need to differ from their neighbours.
_SHADES = ((0.0, 1.0), (0.45, 1.0), (0.0, 0.66), (0.7, 1.0), (0.25, 0.82))
"""Of a colour: the share of white in it, and what it is multiplied by."""
_CLOSE = 1.25  # Grains are neighbours if their centres are at most so many sums of radii apart.


def colours_of_grains(
    bodies: np.ndarray, grains: np.ndarray, positions: np.ndarray
) -> dict[int, np.ndarray]:
    """Return the colour of each grain of the bodies that are grains.

    Grains of one name have the colours of the palette that no other body has; of several names
    shades of the colour of their name.

    Args:
        bodies: number of the name of each particle's body (n,).
        grains: number of the grain among those of its name (n,).
        positions: (n, 3) [m].

    Returns:
        by number of a name, the colours of its grains, shape (grains, 3), 0 to 1.
    """
    if len(bodies) == 0:
        return {}
    most = int(grains.max()) + 1
    each, which = np.unique(bodies.astype(np.int64) * most + grains, return_inverse=True)
    keys = np.column_stack([each // most, each % most])
    heaps = np.flatnonzero(np.bincount(keys[:, 0]) > 1).tolist()
    if not heaps:
        return {}
    kept = np.isin(keys[:, 0], heaps)
    centres, radii = _balls(which, positions, len(keys))
    chosen = np.full(len(keys), -1)
    chosen[kept] = _differing(centres[kept], radii[kept], keys[kept, 0], _palettes(keys, heaps))
    found = {}
    for name, colours in _palettes(keys, heaps).items():
        mine = keys[:, 0] == name
        # Those that are gone in this frame have a colour too, should they be there in another.
        table = np.arange(int(keys[mine, 1].max()) + 1) % len(colours)
        table[keys[mine, 1]] = chosen[mine]
        found[name] = colours[table]
    return found


def _palettes(keys: np.ndarray, heaps: list[int]) -> dict[int, np.ndarray]:
    """Return the colours that the grains of each name may have, by its number."""
    from matplotlib.colors import to_rgb

    every = np.array([to_rgb(colour) for colour in PALETTE], dtype=np.float32)
    taken = {int(name) % len(every) for name in keys[:, 0] if name not in heaps}
    free = [k for k in range(len(every)) if k not in taken]
    if len(heaps) == 1 and len(free) >= _FEWEST:
        return {heaps[0]: every[free]}
    found = {}
    for name in heaps:
        own = every[name % len(every)]
        found[name] = np.array([(own + (1.0 - own) * w) * f for w, f in _SHADES], np.float32)
    return found


def _balls(which: np.ndarray, positions: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return centres (count, 3) and radii (count,) that hold the particles of each grain."""
    many = np.bincount(which, minlength=count)
    sums = [np.bincount(which, positions[:, a], count) for a in range(positions.shape[1])]
    centres = np.column_stack(sums) / many[:, None]
    away = np.linalg.norm(positions - centres[which], axis=1)
    radii = np.zeros(count)
    np.maximum.at(radii, which, away)
    return centres, radii


def _differing(
    centres: np.ndarray, radii: np.ndarray, names: np.ndarray, palettes: dict[int, np.ndarray]
) -> np.ndarray:
    """Return the number of a colour for each grain: one that fewest neighbours have, and others."""
    from scipy.spatial import cKDTree

    finite = np.isfinite(centres).all(axis=1)
    centres = np.where(finite[:, None], centres, 0.0)
    a, b = cKDTree(centres).query_pairs(2.0 * _CLOSE * radii.max(), output_type="ndarray").T
    apart = np.linalg.norm(centres[a] - centres[b], axis=1)
    close = (apart <= _CLOSE * (radii[a] + radii[b])) & (names[a] == names[b])
    ends = np.concatenate([np.column_stack([a, b])[close], np.column_stack([b, a])[close]])
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    first = np.searchsorted(ends[:, 0], np.arange(len(centres) + 1))
    others = ends[:, 1].tolist()
    used = {name: [0] * len(colours) for name, colours in palettes.items()}
    chosen = [-1] * len(centres)
    for k, name in enumerate(names.tolist()):
        around = [0] * len(used[name])
        for other in others[first[k] : first[k + 1]]:
            if chosen[other] >= 0:
                around[chosen[other]] += 1
        chosen[k] = min(range(len(around)), key=lambda c: (around[c], used[name][c]))
        used[name][chosen[k]] += 1
    return np.array(chosen)
