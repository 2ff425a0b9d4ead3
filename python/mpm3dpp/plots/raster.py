# SPDX-License-Identifier: BSD-3-Clause
"""Particles as pixels: squares that tile a body, or lit balls seen from a camera.

Pure numpy, so that a picture needs no graphics driver. Images are bytes, worked out a band of rows
at a time, so that little memory is needed beside the image itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from .coarser import coarser

FINER = 2
"""Pixels that are worked out for each one of an image, along each side, to smooth its edges."""

_INK = np.array([0.1, 0.1, 0.1])
_ROWS = 64  # of pixels that are worked out at a time


def tile(
    centres: np.ndarray,
    sizes: np.ndarray,
    bodies: np.ndarray,
    colours: np.ndarray,
    shape: tuple[int, int],
    outline: int,
    finer: int = 1,
) -> np.ndarray:
    """Squares of the particles' sizes, slits between stretched neighbours closed, outlines inside.

    Args:
        centres: (n, 2) in pixels from the lower left corner.
        sizes: edge of each square (n,) [pixels].
        bodies: number of each particle's body (n,), 0 or more.
        colours: (n, 3), 0 to 1.
        shape: height and width of the image.
        outline: width of the dark line along the edge of each body [finer pixels]; 0 for none.
        finer: edges are smoothed with so many finer pixels along each side of one.

    Returns:
        image (height, width, 4), 0 to 255, transparent where no body is; row 0 is the lowest.
    """
    image = np.zeros((*shape, 4), dtype=np.uint8)
    centres, sizes = finer * centres, finer * sizes
    height, width = finer * shape[0], finer * shape[1]
    order = np.argsort(bodies, kind="stable")
    ends = np.flatnonzero(np.diff(bodies[order])) + 1
    windows = []
    for mine in np.split(order, ends):
        reach = 0.5 * sizes[mine].max()
        close = int(np.ceil(0.6 * reach))
        margin = int(np.ceil(reach)) + close + 2
        low = np.maximum(np.floor(centres[mine].min(axis=0)).astype(int) - margin, 0)
        high = np.ceil(centres[mine].max(axis=0)).astype(int) + margin
        high = np.minimum(high, [width, height])
        if (high > low).all():
            windows.append((mine, reach, close, low, high))
    for row in range(0, height, finer * _ROWS):
        band = np.zeros((min(finer * _ROWS, height - row), width, 4), dtype=np.uint8)
        for mine, reach, close, low, high in windows:
            first, last = max(row, low[1]), min(row + len(band), high[1])
            if first >= last:
                continue
            # What a row shows depends on those so near to it.
            near = 2 * close + outline + 1
            bottom, top = max(first - near, low[1]), min(last + near, high[1])
            y = centres[mine, 1]
            here = mine[(y >= bottom - reach - 2) & (y <= top + reach + 2)]
            if len(here) == 0:  # A gap in the body.
                continue
            corner = np.array([low[0], bottom])
            owner = _squares(centres[here] - corner, sizes[here], (top - bottom, high[0] - low[0]))
            owner = _closed(owner, close)
            inside = owner >= 0
            edge = inside & ~_shrunk(inside, outline) if outline else np.zeros_like(inside)
            rows = slice(first - bottom, last - bottom)
            owner, inside, edge = owner[rows], inside[rows], edge[rows]
            part = band[first - row : last - row, low[0] : high[0]]
            part[inside, :3] = _bytes(colours[here[owner[inside]]])
            part[inside, 3] = 255
            part[edge, :3] = _bytes(_INK)
        image[row // finer : (row + len(band)) // finer] = coarser(band, finer)
    return image


def balls(
    centres: np.ndarray,
    depths: np.ndarray,
    radii: np.ndarray,
    colours: np.ndarray,
    shape: tuple[int, int],
    finer: int = 1,
) -> np.ndarray:
    """Lit balls, the nearer hiding the farther; arguments and result as for `tile`.

    Args:
        depths: distance towards the viewer (n,) [pixels]; larger is nearer.
        radii: (n,) [pixels].
    """
    # Far to near, so that where two balls cover a pixel the nearer is written last.
    order = np.flatnonzero(_not_buried(centres, depths, radii))
    order = order[np.argsort(depths[order], kind="stable")]
    centres, depths = finer * centres[order], finer * depths[order]
    radii, colours = finer * radii[order], colours[order]
    reach, y = int(np.ceil(radii.max())), centres[:, 1]

    def front(bottom: int, top: int) -> tuple[np.ndarray, np.ndarray]:
        here = np.flatnonzero((y >= bottom - reach - 1) & (y <= top + reach + 1))
        at = centres[here] - np.array([0.0, bottom])
        whole = top - bottom, finer * shape[1]
        owner, surface = _nearest(at, depths[here], radii[here], whole, reach)
        owner[owner >= 0] = here[owner[owner >= 0]]
        return owner, surface

    return _lit(front, centres, radii, colours, shape, finer)


def balls_of_owners(
    owners: np.ndarray,
    centres: np.ndarray,
    depths: np.ndarray,
    radii: np.ndarray,
    colours: np.ndarray,
    finer: int = 1,
) -> np.ndarray:
    """The image of `balls` where it is known which ball is in front at each finer pixel.

    Args:
        owners: its number, -1 for none, shape (finer height, finer width); row 0 is the lowest.
    """
    centres, depths, radii = finer * centres, finer * depths, finer * radii
    shape = owners.shape[0] // finer, owners.shape[1] // finer

    def front(bottom: int, top: int) -> tuple[np.ndarray, np.ndarray]:
        owner = owners[bottom:top]
        y, x = np.nonzero(owner >= 0)
        who = owner[y, x]
        flat = (x - centres[who, 0]) ** 2 + (y + bottom - centres[who, 1]) ** 2
        surface = np.full(owner.shape, -np.inf)
        surface[y, x] = depths[who] + np.sqrt(np.maximum(0.0, radii[who] ** 2 - flat))
        return owner, surface

    return _lit(front, centres, radii, colours, shape, finer)


def _lit(
    front: Callable[[int, int], tuple[np.ndarray, np.ndarray]],
    centres: np.ndarray,
    radii: np.ndarray,
    colours: np.ndarray,
    shape: tuple[int, int],
    finer: int,
) -> np.ndarray:
    """Return the image of balls; `front` gives number and nearness of those of a band of rows."""
    image = np.zeros((*shape, 4), dtype=np.uint8)
    height, width = finer * shape[0], finer * shape[1]
    radius = float(np.median(radii))
    near = max(1, round(0.5 * radius))  # As far as `_step` looks.
    for row in range(0, height, finer * _ROWS):
        end = min(row + finer * _ROWS, height)
        bottom, top = max(row - near, 0), min(end + near, height)
        owner, surface = front(bottom, top)
        rows = slice(row - bottom, end - bottom)
        shade = 1.0 - 0.55 * _step(surface, radius, near)[rows]
        drawn = owner[rows] >= 0
        y, x = np.nonzero(drawn)
        who = owner[rows][drawn]
        n = (np.column_stack([x, y + row]) - centres[who]) / radii[who, None]
        towards = np.sqrt(np.maximum(0.0, 1.0 - (n**2).sum(axis=1)))
        light = 0.62 + 0.38 * np.clip(-0.35 * n[:, 0] + 0.55 * n[:, 1] + 0.76 * towards, 0.0, 1.0)
        band = np.zeros((end - row, width, 4), dtype=np.uint8)
        band[drawn, :3] = _bytes(colours[who] * (light * shade[drawn])[:, None])
        band[drawn, 3] = 255
        image[row // finer : end // finer] = coarser(band, finer)
    return image


def _bytes(colours: np.ndarray) -> np.ndarray:
    """Colours from 0 to 1 as whole numbers from 0 to 255."""
    return np.round(255.0 * colours).astype(np.uint8)


def _nearest(
    centres: np.ndarray, depths: np.ndarray, radii: np.ndarray, shape: tuple[int, int], reach: int
) -> tuple[np.ndarray, np.ndarray]:
    """Number of the ball in front at each pixel, -1 for none, and how near it is [pixels]."""
    height, width = shape
    surface = np.full(height * width, -np.inf)
    owner = np.full(height * width, -1, dtype=np.int32)
    if len(centres) < 4 * (2 * reach + 1) ** 2:  # Few large ones: ball by ball.
        front_of = surface.reshape(shape), owner.reshape(shape)
        for k, ((x, y), radius) in enumerate(zip(centres, radii, strict=True)):
            _cover(*front_of, k, float(x), float(y), float(depths[k]), float(radius))
        return front_of[1], front_of[0]
    base = np.round(centres).astype(int)
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            x, y = base[:, 0] + dx, base[:, 1] + dy
            flat = ((x - centres[:, 0]) ** 2 + (y - centres[:, 1]) ** 2) / radii**2
            seen = (flat <= 1.0) & (x >= 0) & (x < width) & (y >= 0) & (y < height)
            who, pixel = np.flatnonzero(seen), (y * width + x)[seen]
            front = depths[who] + radii[who] * np.sqrt(1.0 - flat[seen])
            nearer = front > surface[pixel]
            who, pixel, front = who[nearer], pixel[nearer], front[nearer]
            surface[pixel] = front  # last writer wins, which is the nearest ball
            owner[pixel] = who
    return owner.reshape(shape), surface.reshape(shape)


def _cover(
    surface: np.ndarray, owner: np.ndarray, k: int, x: float, y: float, depth: float, radius: float
) -> None:
    """Put ball `k` before what lies behind it."""
    height, width = owner.shape
    left, right = max(math.ceil(x - radius), 0), min(math.floor(x + radius) + 1, width)
    low, high = max(math.ceil(y - radius), 0), min(math.floor(y + radius) + 1, height)
    if left >= right or low >= high:
        return
    across, along = (np.arange(left, right) - x) / radius, (np.arange(low, high) - y) / radius
    flat = across**2 + along[:, None] ** 2
    front = depth + radius * np.sqrt(np.maximum(0.0, 1.0 - flat))
    part = surface[low:high, left:right]
    nearer = (flat <= 1.0) & (front > part)
    part[nearer] = front[nearer]
    owner[low:high, left:right][nearer] = k


def _not_buried(centres: np.ndarray, depths: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Balls that may be seen: not far behind the nearest ones all around them."""
    radius = float(radii.max())
    place = np.floor(centres / (1.6 * radius)).astype(np.int32)
    place -= place.min(axis=0) - 1
    front = np.full(place.max(axis=0) + 2, -np.inf)
    np.maximum.at(front, (place[:, 0], place[:, 1]), depths)
    least = front.copy()
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            least = np.minimum(least, np.roll(front, (dx, dy), axis=(0, 1)))
    return depths > least[place[:, 0], place[:, 1]] - 4.0 * radius


def _step(surface: np.ndarray, radius: float, reach: int) -> np.ndarray:
    """How far the surface falls away behind a nearer part, 0 to 1: edges and corners show."""
    nearer = surface.copy()
    for axis in (0, 1):
        across, shifted = np.moveaxis(nearer, axis, 0), np.moveaxis(surface, axis, 0)
        np.maximum(across[reach:], shifted[:-reach], out=across[reach:])
        np.maximum(across[:-reach], shifted[reach:], out=across[:-reach])
    with np.errstate(invalid="ignore"):
        step = np.clip((nearer - surface) / (6.0 * radius) - 0.15, 0.0, 1.0)
    step[~np.isfinite(step)] = 0.0
    return step


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
    from scipy.ndimage import distance_transform_edt

    away, nearest = distance_transform_edt(owner < 0, return_indices=True)
    grown = away <= steps
    inside = grown if grown.all() else distance_transform_edt(grown) > steps
    return np.where(inside | (owner >= 0), owner[tuple(nearest)], -1)


def _shrunk(mask: np.ndarray, steps: int) -> np.ndarray:
    """The mask without a rim of `steps` pixels."""
    from scipy.ndimage import distance_transform_edt

    inside: np.ndarray = distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1] > steps
    return inside
