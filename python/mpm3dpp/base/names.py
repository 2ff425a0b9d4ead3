# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of bodies by their names: bodies of one name, which follow one another, are grains."""

from __future__ import annotations

from collections.abc import Sequence


def numbered(names: Sequence[str]) -> tuple[list[str], list[int]]:
    """Return the different names in their order, and the number of each name in that list."""
    numbers = {name: k for k, name in enumerate(dict.fromkeys(names))}
    return list(numbers), [numbers[name] for name in names]


def grain_numbers(names: Sequence[str]) -> list[int]:
    """Return the number of each body among those of its name."""
    firsts: dict[str, int] = {}
    return [b - firsts.setdefault(name, b) for b, name in enumerate(names)]
