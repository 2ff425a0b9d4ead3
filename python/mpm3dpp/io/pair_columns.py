# SPDX-License-Identifier: BSD-3-Clause
"""The columns of `history.csv` for each pair of bodies: `contact_force_A_B_x` and so on."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Iterator, Sequence

PAIR_LIMIT = 66
"""Most pairs that get columns of their own (12 names); more go to `contact_pairs.csv`."""

FORCE = "contact_force_"


def pairs_with_columns(bodies: Sequence[int]) -> list[tuple[int, int]] | None:
    """Return all pairs; None where they are too many for columns, and never listed."""
    count = len(bodies) * (len(bodies) - 1) // 2
    return list(itertools.combinations(bodies, 2)) if count <= PAIR_LIMIT else None


def pairs_of(columns: Iterable[str], bodies: Collection[str]) -> Iterator[tuple[str, str, str]]:
    """Give of each pair that has columns its names and the name of its force without the axis.

    Args:
        columns: names of all columns.
        bodies: names, which tell where in that of a column one ends and the next begins.
    """
    known = set(bodies)
    for column in columns:
        if not (column.startswith(FORCE) and column.endswith("_x")):
            continue
        pair = column[len(FORCE) : -len("_x")]
        for k, letter in enumerate(pair):
            if letter == "_" and pair[:k] in known and pair[k + 1 :] in known:
                yield pair[:k], pair[k + 1 :], column[: -len("_x")]
                break
