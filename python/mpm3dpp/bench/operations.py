# SPDX-License-Identifier: BSD-3-Clause
"""How many additions and multiplications a step takes, to say how near it is to the best possible.

Counted is what the equations say as they are written, for each particle and each node that it
reaches (2^D with the linear basis, 3^D with GIMP and the quadratic B-spline): the product of
one-axis factors for N_ip, D of them for its gradient, and a multiplication and an addition for each
term of a sum. A code that shares work among the particles of a cell, as this one does, makes fewer:
it is an upper estimate. Not counted are nodes, the one-axis factors themselves and distances along
an axis, lists, what the ledger sums, and what lanes that are empty do.
"""

from __future__ import annotations

from typing import NamedTuple

from mpm3dpp import _core

from .traffic import moves_particles

# Of a material for a particle and step (3D, plane strain), by hand from `cpp/mpm/materials`: strain
# and spin (12, 4), rotation of the stress (36, 8), law, volume and energies; a division or a
# function such as exp counts as one.
LAWS = {"elastic": (95, 40), "johnson_cook": (230, 160)}


class Take(NamedTuple):
    """What a transfer does for v_p: sums over the nodes, and operations beside them a component."""

    sums: int
    beside: int


# Sums of increments (flip), of velocities (pic, apic) or of both. XPIC is not among them, whose
# filter goes through the particles as often as its order says.
TAKES = {"flip": Take(1, 1), "pic": Take(1, 0), "apic": Take(1, 0), "aflip": Take(2, 4)}


def operations_per_particle_step(
    stages: list[str], dimension: int, basis: str, transfer: str, law: str
) -> dict[str, int]:
    """Return the operations of each stage per particle and step.

    Stages of nodes only have none; of stages that nobody has counted here none are known, and 0 is
    returned too.

    Args:
        stages: names of the stages of a scheme.
        dimension: 2 or 3.
        basis: a word of `grid.basis`.
        transfer: a word of `run.transfer` that is counted.
        law: of the material, a key of `LAWS`.

    Raises:
        KeyError: a stage is not in `traffic.STAGES`.
    """
    d = dimension
    nodes = _core.bases[basis]["nodes"] ** d
    function, gradient = nodes * (d - 1), nodes * d * (d - 1)
    weighted, mass = nodes, nodes  # m N_ip, and its sum
    vector, tensor = 2 * nodes * d, 2 * nodes * d * d
    update = gradient + tensor + LAWS[law][3 - d]
    take = TAKES[transfer]
    advance = function + take.sums * vector + take.beside * d
    of_grid, along = vector, 2 * d  # eq. (16): the sum of v_i N_ip, and dt times it
    sum_is_there = transfer != "flip"
    if _core.transfers[transfer]["affine"]:
        vector += tensor  # p_i has C_p (x_i - x_p) beside v_p
        advance += tensor + d * d  # C_p = sum N_ip v_i (x_i - x_p) / D
        # C : C; C_p - dt/2 (C_p C_p + (C_p C_p)^T), of which the change is symmetric. Not counted:
        # `closing_part` (step/transfer/apic.hpp), which few particles need.
        along += 2 * d * d + 2 * d * d * (d + 1) + 2 * d * d
    move = function + of_grid + along
    counts = {
        "map momentum": function + weighted + mass + vector,  # eqs. (2), (3)
        "map forces": gradient + tensor,  # eq. (9)
        "map momentum and forces": function + weighted + mass + vector + gradient + tensor,
        "advance particles": advance,  # eq. (17)
        "remap momentum": function + weighted + vector,
        "advance and remap particles": advance + weighted + vector,
        "advance and move particles": advance + along + (0 if sum_is_there else of_grid),
        "update stress": update,  # eqs. (18)-(20)
        "update stress, move particles": update + move,
        "move particles": move,  # eq. (16)
    }
    return {stage: counts.get(stage, 0) if moves_particles(stage) else 0 for stage in stages}
