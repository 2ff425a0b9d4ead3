# SPDX-License-Identifier: BSD-3-Clause
"""About how much memory a case takes, before it runs."""

from __future__ import annotations

import numpy as np

from mpm3dpp import _core
from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.case.case import Case
from mpm3dpp.fill.parts import Filled, FilledPart, Particles
from mpm3dpp.fill.surface_points import ALONG, point_spacing
from mpm3dpp.grains.packing import ball_volume
from mpm3dpp.io.background import FRAME_SHARE
from mpm3dpp.materials import state_columns

# Estimates for the echo [bytes], in 2D and 3D: a particle with its lists but without the state of
# its material, and a node that it reaches, with those that lie beside it in blocks and in contact.
# (Before particles are made, PARTICLE_BYTES_WITH_GRID of machine.py stands for both together.)
_PARTICLE_BYTES, _NODE_BYTES = {2: 96, 3: 128}, {2: 150, 3: 200}
_POINT_BYTES = {2: 200, 3: 240}  # Of a contact point of a surface, with those near to it.
_HISTORY_BYTES = 8 * (_core.Simulation.history_capacity + 1) * len(_core.history_terms)
_BYTES_OF_FRAME = 18 << 10  # what is known of it, and the writing of results.vtkhdf: measured
_WITH_EDGES = 1.15  # of a rank's part of the core's memory
_PROGRAM_BYTES = 62 << 20
"""Python and the libraries of a run, and what its start leaves [bytes]: measured with CPython 3.11,
numpy 2.4 and h5py 3.16 on Linux."""
_SEARCH_BYTES = 57_000_000
"""What finds the particles of contact points [bytes]: measured likewise, with scipy 1.17."""


def occupied_cells(case: Case, bodies: Filled) -> int:
    """Return the number of grid cells that hold particles, each body counted by itself."""
    return sum(
        len(_cells(case, some, 0.0)[0]) for part in bodies.parts.values() for some in part.chunks()
    )


def _cells(case: Case, some: Particles, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of the cells that hold particles, and the steps to the next on each axis.

    Cells begin `shift` of a cell before the nodes; around a body there is room for what it reaches.
    """
    room = max(basis["nodes"] for basis in _core.bases.values()) - 1
    owner = np.repeat(np.arange(len(some.counts)), some.counts)
    cells = np.floor((some.positions - np.asarray(case.grid.lower)) / case.grid.cell_size + shift)
    cells -= cells.min(axis=0) - room
    strides = np.cumprod([1.0, *(cells.max(axis=0) + room + 1)])
    return np.unique(cells @ strides[:-1] + owner * strides[-1]), strides[:-1]


def memory_bytes(case: Case, bodies: Filled) -> int:
    """Return about what the core will need: of particles, the nodes that each body reaches, rows of
    the history that wait."""
    basis, total = _core.bases[case.grid.basis], _HISTORY_BYTES
    transfer, D = _core.transfers[case.run.transfer.word], case.grid.dimension
    taken = 8 * (D * D * transfer["affine"] + D * transfer["filters"] + case.has_set_back)
    reached = np.arange(basis["nodes"]) - basis["before"]  # From a cell's own node, along an axis.
    apart = point_spacing(case, bodies.parts.values())
    for part in bodies.parts.values():
        state = state_columns(case.material[part.material].models)
        each = _PARTICLE_BYTES[D] + taken + 8 * len(state)
        if kept := case.parts()[part.name].frame == MATERIAL:
            each += 8 * (D + D * D) - taken  # Where it was, and the deformation.
        elif apart is not None and case.contact_enabled and not case.is_rigid(part.name):
            each += 8 * (3 * D + 4)  # What it remembers of the surfaces that it presses.
        total += each * part.count
        carries = kept or (case.is_rigid(part.name) and case.contact_enabled)
        if carries and apart is not None:
            total += round(_POINT_BYTES[D] * _surface(case, part) / (apart / ALONG[D]) ** (D - 1))
        for some in part.chunks():
            nodes, strides = _cells(case, some, basis["own_node"])
            for stride in strides:
                nodes = np.unique(np.add.outer(stride * reached, nodes))
            total += (_NODE_BYTES[D] + 8 * 4 * kept) * len(nodes)
    return total


def _surface(case: Case, part: FilledPart) -> float:
    """Return about the surface of the bodies of a part [m^2; in 2D m]: of others than balls that of
    the cells which hold particles."""
    D = case.grid.dimension
    if part.balls is not None:
        radii = np.asarray(part.balls[1], dtype=float)
        return float((D / radii * ball_volume(radii, D)).sum())
    faces = 0
    for some in part.chunks():
        cells, strides = _cells(case, some, 0.0)
        faces += sum(2 * int((~np.isin(cells + stride, cells)).sum()) for stride in strides)
    return faces * float(case.grid.cell_size) ** (D - 1)


def process_bytes(core: int, frames: int = 0, surfaces: bool = False) -> int:
    """Return about the peak of the process of a run that writes frames, by that of the core.

    Args:
        core: bytes of the core.
        frames: how many.
        surfaces: whether bodies touch by points of their surfaces, which are searched for.

    Pictures have a process of their own.
    """
    program = _PROGRAM_BYTES + surfaces * _SEARCH_BYTES
    return program + round((1.0 + FRAME_SHARE) * core) + _BYTES_OF_FRAME * frames


def rank_line(core: int, ranks: int) -> str:
    """Return the line about the memory of each of several ranks, by that of one core alone."""
    # A rank has the nodes of others beside its own, and room for particles that come.
    core = round(_WITH_EDGES * core / ranks)
    return (
        f"ranks: each of {ranks} about {(_PROGRAM_BYTES + core) / 2**20:,.0f} MiB, of which the "
        f"core {core / 2**20:,.1f} MiB; the first one as much more as a frame takes"
    )
