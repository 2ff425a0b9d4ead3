# SPDX-License-Identifier: BSD-3-Clause
"""How many bytes a step must move, to say how much of the memory bandwidth it uses.

Counted is what each stage has to read from and write to the particles' columns, once per particle
and step, and the 4 bytes of the list by which it finds them. A number has 8 bytes, but where a
build with MPM_FLOAT32 keeps floats 4. A stage that reads a column again that an earlier stage has
read counts it again: for more particles than the caches hold it does come from memory again. Not
counted are the nodes (64 bytes each, which a step goes through some ten times: in large problems
they come from memory too), the sorting of columns, and the mending of lists, so the fraction of the
bandwidth that follows is a lower bound. A small problem stays in the caches, and its fraction can
exceed 1. The affine part counts with the transfers that have it.
"""

from __future__ import annotations

from mpm3dpp import _core

_LIST = 4  # Bytes of an entry of the list of particles by cell.
_ROUNDED = {"float64": 8, "float32": 4}[_core.build_info()["velocity_and_stress"]]
_AFFINE = "affine part"
_BYTES = dict.fromkeys(("velocity", "stress", _AFFINE), _ROUNDED)  # Of a number; of all others 8.

_COLUMNS = ("position", "velocity", "mass", "volume", "stress", _AFFINE)


def _touched() -> dict[str, tuple[tuple[str, ...], tuple[str, ...]]]:
    """Return of each stage the columns that it reads and writes, as the core's lists say.

    Stages that touch nodes only move no particles, nor do those of rigid bodies, which benchmarks
    do not have, nor those that look at a few.
    """
    touched = {}
    for scheme in _core.schemes:
        for name, *data, all_particles in (
            *_core.stages(scheme, True),
            *_core.stages(scheme, False),
        ):
            read, written = (tuple(c for c in _COLUMNS if c in words) for words in data)
            touched[name] = (read, written) if all_particles else ((), ())
    return touched


STAGES = _touched()


def moves_particles(stage: str) -> bool:
    """Return whether a stage reads particles; raise KeyError if there is no such stage."""
    return STAGES[stage] != ((), ())


def numbers(column: str, dimension: int) -> int:
    """Return how many numbers a column holds per particle."""
    if column == "stress":
        return 6 if dimension == 3 else 4  # Plane strain keeps xx yy zz xy.
    if column == _AFFINE:
        return dimension * dimension
    return dimension if column in ("position", "velocity") else 1


def bytes_per_particle_step(
    stages: list[str], dimension: int, transfer: str, state: int = 0
) -> dict[str, int]:
    """Return the bytes that each stage moves per particle and step.

    Args:
        stages: names of the stages of a scheme.
        dimension: 2 or 3.
        transfer: a word of `run.transfer` that `operations.TAKES` has.
        state: numbers of the material's state, which the stress stage reads and writes.

    Raises:
        KeyError: there is no such stage.
    """
    moved = {}
    affine = _core.transfers[transfer]["affine"]
    for stage in stages:
        read, written = STAGES[stage]
        columns = sum(
            numbers(column, dimension) * _BYTES.get(column, 8)
            for column in (*read, *written)
            if affine or column != _AFFINE
        )
        columns += 2 * state * 8 if stage.startswith("update stress") else 0
        moved[stage] = columns + _LIST if columns else 0
    return moved
