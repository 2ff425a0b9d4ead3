# SPDX-License-Identifier: BSD-3-Clause
"""Particles as pixels: squares that tile a body, or lit balls seen from a camera.

Pure numpy, so that a picture needs no graphics driver; the images are made larger than they
are shown, and what draws them smooths the edges.
"""

from __future__ import annotations

import numpy as np

_INK = np.array([0.1, 0.1, 0.1])


def tile(
    centres: np.ndarray,
    sizes: np.ndarray,
    bodies: np.ndarray,
    colours: np.ndarray,
    shape: tuple[int, int],
    outline: int,
) -> np.ndarray:
    """Squares of the particles' sizes, slits between stretched neighbours closed, outlines inside.

    Args:
        centres: (n, 2) in pixels from the lower left corner.
        sizes: edge of each square (n,) [pixels].
        bodies: number of each particle's body (n,), 0 or more.
        colours: (n, 3), 0 to 1.
        shape: height and width of the image.
        outline: width of the dark line along the edge of each body [pixels]; 0 for none.

    Returns:
        image (height, width, 4), 0 to 1, transparent where no body is; row 0 is the lowest.
    """
    image = np.zeros((*shape, 4), dtype=np.float32)
    order = np.argsort(bodies, kind="stable")
    ends = np.flatnonzero(np.diff(bodies[order])) + 1
    for mine in np.split(order, ends):
        reach = 0.5 * sizes[mine].max()
        close = int(np.ceil(0.6 * reach))
        margin = int(np.ceil(reach)) + close + 2
        low = np.maximum(np.floor(centres[mine].min(axis=0)).astype(int) - margin, 0)
        high = np.ceil(centres[mine].max(axis=0)).astype(int) + margin
        high = np.minimum(high, [shape[1], shape[0]])
        if (high <= low).any():
            continue
        window = (int(high[1] - low[1]), int(high[0] - low[0]))
        owner = _squares(centres[mine] - low, sizes[mine], window)
        owner = _closed(owner, close)
        inside = owner >= 0
        part = image[low[1] : high[1], low[0] : high[0]]
        part[inside, :3] = colours[mine][owner[inside]]
        part[inside, 3] = 1.0
        if outline:
            edge = inside & ~_shrunk(inside, outline)
            part[edge, :3] = _INK
    return image


def balls(
    centres: np.ndarray,
    depths: np.ndarray,
    radii: np.ndarray,
    colours: np.ndarray,
    shape: tuple[int, int],
) -> np.ndarray:
    """Lit balls, the nearer hiding the farther; arguments as for `tile`.

    Args:
        depths: distance towards the viewer (n,) [pixels]; larger is nearer.
        radii: (n,) [pixels].
    """
    height, width = shape
    surface = np.full(height * width, -np.inf)
    owner = np.full(height * width, -1, dtype=np.int32)
    normal = np.zeros((height * width, 2))
    # Far to near, so that where two balls cover a pixel the nearer is written last.
    order = np.flatnonzero(_not_buried(centres, depths, radii))
    order = order[np.argsort(depths[order], kind="stable")]
    base = np.round(centres).astype(int)
    reach = int(np.ceil(radii.max()))
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            x, y = base[order, 0] + dx, base[order, 1] + dy
            away = np.column_stack([x, y]) - centres[order]
            flat = (away**2).sum(axis=1) / radii[order] ** 2
            seen = (flat <= 1.0) & (x >= 0) & (x < width) & (y >= 0) & (y < height)
            if not seen.any():
                continue
            who, pixel = order[seen], (y * width + x)[seen]
            front = depths[who] + radii[who] * np.sqrt(1.0 - flat[seen])
            nearer = front > surface[pixel]
            who, pixel, front = who[nearer], pixel[nearer], front[nearer]
            surface[pixel] = front  # last writer wins, which is the nearest ball
            owner[pixel] = who
            normal[pixel] = away[seen][nearer] / radii[who, None]
    image = np.zeros((height * width, 4))
    drawn = owner >= 0
    n = normal[drawn]
    towards = np.sqrt(np.maximum(0.0, 1.0 - (n**2).sum(axis=1)))
    light = 0.62 + 0.38 * np.clip(-0.35 * n[:, 0] + 0.55 * n[:, 1] + 0.76 * towards, 0.0, 1.0)
    image[drawn, :3] = colours[owner[drawn]] * light[:, None]
    image[drawn, 3] = 1.0
    picture = image.reshape(height, width, 4)
    _darken_steps(picture, surface.reshape(height, width), float(np.median(radii)))
    return picture


def _not_buried(centres: np.ndarray, depths: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Balls that may be seen: not far behind the nearest ones all around them."""
    radius = float(radii.max())
    place = np.floor(centres / (1.6 * radius)).astype(int)
    place -= place.min(axis=0) - 1
    front = np.full(place.max(axis=0) + 2, -np.inf)
    np.maximum.at(front, (place[:, 0], place[:, 1]), depths)
    least = front.copy()
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            least = np.minimum(least, np.roll(front, (dx, dy), axis=(0, 1)))
    return depths > least[place[:, 0], place[:, 1]] - 4.0 * radius


def _darken_steps(image: np.ndarray, surface: np.ndarray, radius: float) -> None:
    """Shade where the surface falls away behind a nearer part: edges and corners show."""
    reach = max(1, round(0.5 * radius))
    nearer = surface.copy()
    for shift in (-reach, reach):
        for axis in (0, 1):
            nearer = np.maximum(nearer, np.roll(surface, shift, axis=axis))
    with np.errstate(invalid="ignore"):
        step = np.clip((nearer - surface) / (6.0 * radius) - 0.15, 0.0, 1.0)
    step[~np.isfinite(step)] = 0.0
    image[..., :3] *= (1.0 - 0.55 * step)[..., None]


def _squares(centres: np.ndarray, sizes: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Number of the particle whose square covers each pixel, -1 for none."""
    height, width = shape
    owner = np.full(height * width, -1, dtype=np.int32)
    # squares reach from floor(low) to floor(high), so that neighbours share an edge exactly
    first = np.floor(centres - 0.5 * sizes[:, None] + 1e-6).astype(int)
    last = np.floor(centres + 0.5 * sizes[:, None] + 1e-6).astype(int)
    last = np.maximum(last, first + 1)
    span = last - first
    for dy in range(int(span[:, 1].max())):
        for dx in range(int(span[:, 0].max())):
            x, y = first[:, 0] + dx, first[:, 1] + dy
            seen = (dx < span[:, 0]) & (dy < span[:, 1])
            seen &= (x >= 0) & (x < width) & (y >= 0) & (y < height)
            owner[(y * width + x)[seen]] = np.flatnonzero(seen)
    return owner.reshape(height, width)


def _closed(owner: np.ndarray, steps: int) -> np.ndarray:
    """Fill slits narrower than 2 `steps` pixels with the nearest particle."""
    grown = owner.copy()
    for k in range(steps):
        before = grown.copy()
        for source, target in _neighbours(before.shape, diagonal=k % 2 == 1):
            take = (grown[target] < 0) & (before[source] >= 0)
            grown[target][take] = before[source][take]
    keep = grown >= 0
    for k in range(steps):
        before_mask = keep.copy()
        for source, target in _neighbours(keep.shape, diagonal=k % 2 == 1):
            keep[target] &= before_mask[source]
    return np.where(keep | (owner >= 0), grown, -1)


def _shrunk(mask: np.ndarray, steps: int) -> np.ndarray:
    """The mask without a rim of `steps` pixels."""
    mask = np.pad(mask, 1)
    for k in range(steps):
        before = mask.copy()
        for source, target in _neighbours(mask.shape, diagonal=k % 2 == 1):
            mask[target] &= before[source]
    return mask[1:-1, 1:-1]


def _neighbours(
    shape: tuple[int, int], diagonal: bool
) -> list[tuple[tuple[slice, slice], tuple[slice, slice]]]:
    """Pairs of windows (source, target) that shift an image by one pixel each way.

    Four neighbours and eight in turn make a rounder shape than either.
    """
    steps = [(1, 0), (-1, 0), (0, 1), (0, -1)]
    if diagonal:
        steps += [(1, 1), (1, -1), (-1, 1), (-1, -1)]

    def window(step: int, size: int) -> tuple[slice, slice]:
        if step == 0:
            return slice(0, size), slice(0, size)
        return (slice(0, size - 1), slice(1, size))[:: 1 if step > 0 else -1]  # type: ignore

    pairs = []
    for dy, dx in steps:
        ys, yt = window(dy, shape[0])
        xs, xt = window(dx, shape[1])
        pairs.append(((ys, xs), (yt, xt)))
    return pairs
