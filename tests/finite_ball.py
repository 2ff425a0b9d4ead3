# SPDX-License-Identifier: BSD-3-Clause
"""How far a ball yields where it is pushed, by finite elements: a half-space is not quite it.

A ball that is pushed on a circle, and held by its inertia alone, yields there by Hertz's and
Mindlin's half-space (the leading 1/a) and by a part of its own, of the order of the radius: it is
stiffer along the normal, as its middle is near, and softer along the surface, as it bends there.
Fields of revolution with cos and sin of the angle about the normal; biquadratic elements.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve

GAUSS = (np.array([-(0.6**0.5), 0.0, 0.6**0.5]), np.array([5.0, 8.0, 5.0]) / 9.0)
IN_CIRCLE, ALONG, INWARDS = 8, 36, 24  # elements


def _graded(first: float, count: int, total: float) -> np.ndarray:
    """Ends of elements from 0 to `total`, each longer than the one before by the same factor."""
    factor = brentq(lambda q: first * (q**count - 1) / (q - 1) - total, 1 + 1e-6, 3.0)
    ends = np.append(0.0, np.cumsum(first * factor ** np.arange(count)))
    return ends * (total / ends[-1])


def _with_middles(ends: np.ndarray) -> np.ndarray:
    return np.sort(np.append(ends, 0.5 * (ends[1:] + ends[:-1])))


def _functions(s: float) -> tuple[np.ndarray, np.ndarray]:
    """The three functions of an element along one direction, and their derivatives."""
    return (
        np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2]),
        np.array([s - 0.5, -2 * s, s + 0.5]),
    )


def _mesh(circle: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Distances from the axis, heights, nodes of each element, and numbers along and inwards."""
    edge = np.arcsin(circle)
    far = edge + _graded(edge / IN_CIRCLE, ALONG - IN_CIRCLE, np.pi - edge)[1:]
    angles = _with_middles(np.append(np.linspace(0, edge, IN_CIRCLE + 1), far))
    radii = 1.0 - _with_middles(_graded(edge / IN_CIRCLE, INWARDS, 1.0))
    r = np.outer(np.sin(angles), radii).ravel()
    z = np.outer(np.cos(angles), radii).ravel()
    number = np.arange(len(r)).reshape(len(angles), len(radii))
    elements = [
        number[2 * i : 2 * i + 3, 2 * j : 2 * j + 3].ravel()
        for i in range(ALONG)
        for j in range(INWARDS)
    ]
    return r, z, np.array(elements), number


def _strains(n: int, N: np.ndarray, by_r: np.ndarray, by_z: np.ndarray, r: np.ndarray) -> Any:
    """rr, tt, zz, rz, rt, tz of (U cos, V sin, W cos) of n times the angle, by the nodes'."""
    B = np.zeros((len(r), 6, 9, 3))
    over_r = N / r[:, None]
    B[:, 0, :, 0], B[:, 2, :, 2] = by_r, by_z
    B[:, 1, :, 0], B[:, 1, :, 1] = over_r, n * over_r
    B[:, 3, :, 0], B[:, 3, :, 2] = by_z, by_r
    B[:, 4, :, 0], B[:, 4, :, 1] = -n * over_r, by_r - over_r
    B[:, 5, :, 1], B[:, 5, :, 2] = by_z, -n * over_r
    return B.reshape(len(r), 6, 27)


def _matrices(r: np.ndarray, z: np.ndarray, elements: np.ndarray, nu: float, n: int) -> Any:
    """Stiffness for E = 1 and mass for a density of 1."""
    G = 0.5 / (1 + nu)
    C = np.diag([2 * G] * 3 + [G] * 3)
    C[:3, :3] += nu / ((1 + nu) * (1 - 2 * nu))
    stiffness = np.zeros((len(elements), 27, 27))
    mass = np.zeros((len(elements), 9, 9))
    for s, weight_s in zip(*GAUSS, strict=True):
        for t, weight_t in zip(*GAUSS, strict=True):
            (a, da), (b, db) = _functions(s), _functions(t)
            N, Ns, Nt = (np.outer(*pair).ravel() for pair in ((a, b), (da, b), (a, db)))
            rs, rt, zs, zt = (of[elements] @ by for of in (r, z) for by in (Ns, Nt))
            J = (rs * zt - rt * zs)[:, None]
            by_r = (Ns * zt[:, None] - Nt * zs[:, None]) / J
            by_z = (Nt * rs[:, None] - Ns * rt[:, None]) / J
            at = r[elements] @ N
            w = weight_s * weight_t * abs(J[:, 0]) * at * (np.pi if n else 2 * np.pi)
            B = _strains(n, N, by_r, by_z, at)
            stiffness += w[:, None, None] * (B.transpose(0, 2, 1) @ C @ B)
            mass += w[:, None, None] * np.outer(N, N)
    size = 3 * len(r)
    places = (3 * elements[:, :, None] + np.arange(3)).reshape(len(elements), 27)

    def whole(parts: np.ndarray, of: np.ndarray, size: int) -> Any:
        rows, columns = np.repeat(of, of.shape[1], 1), np.tile(of, (1, of.shape[1]))
        return sparse.csr_matrix((parts.ravel(), (rows.ravel(), columns.ravel())), (size, size))

    return whole(stiffness, places, size), whole(mass, elements, len(r))


def _push(r: np.ndarray, z: np.ndarray, number: np.ndarray, circle: float, n: int) -> np.ndarray:
    """Forces of the pressure of a stiff flat end, (1 - x^2/a^2)^(-1/2), down or along x."""
    forces = np.zeros((len(r), 3))
    for i in range(IN_CIRCLE):
        nodes = number[2 * i : 2 * i + 3, 0]
        for s, weight in zip(*np.polynomial.legendre.leggauss(20), strict=True):
            N, dN = _functions(s)
            at = r[nodes] @ N
            length = np.hypot(r[nodes] @ dN, z[nodes] @ dN)
            part = weight * at * length * N / np.sqrt(1 - min(at / circle, 1 - 1e-12) ** 2)
            if n:
                forces[nodes, 0] += part
                forces[nodes, 1] -= part
            else:
                forces[nodes, 2] -= part
    total = forces[:, 0].sum() - forces[:, 1].sum() if n else -forces[:, 2].sum()
    return forces.ravel() / total


def yields(circle: float, nu: float, along: bool) -> float:
    """How far the circle goes against the body as a whole by a force of 1, with E = R = 1.

    Args:
        circle: radius of the circle over that of the ball.
        nu: Poisson's ratio.
        along: along the surface; else along the normal.
    """
    n = int(along)
    r, z, elements, number = _mesh(circle)
    K, M = _matrices(r, z, elements, nu, n)
    moves = np.zeros((len(r), 3, 2 if n else 1))  # of the body as a whole
    on_axis = np.flatnonzero(r < 1e-9)
    held = np.zeros((len(r), 3))
    if n:
        moves[:, 0, 0], moves[:, 1, 0] = 1.0, -1.0
        moves[:, 0, 1], moves[:, 1, 1], moves[:, 2, 1] = z, -z, -r
        held[on_axis, 2] = 1e6
    else:
        moves[:, 2, 0] = 1.0
        held[:, 1], held[on_axis, 0] = 1e6, 1e6
    rigid = moves.reshape(3 * len(r), -1)
    inertia = sparse.csr_matrix(sparse.kron(M, sparse.eye(3)) @ rigid)
    K = K + sparse.diags(held.ravel())
    whole = sparse.bmat([[K, inertia], [inertia.T, None]]).tocsc()
    forces = _push(r, z, number, circle, n)
    found = spsolve(whole, np.append(forces, np.zeros(rigid.shape[1])))
    return float(forces @ found[: len(forces)])


def own_part(circle: float, nu: float, along: bool) -> float:
    """The part of `yields` beyond that of the half-space: 1 / 2aE* or 1 / 2aG*."""
    half_space = (2 - nu) * (1 + nu) / (4 * circle) if along else (1 - nu**2) / (2 * circle)
    return yields(circle, nu, along) - half_space
