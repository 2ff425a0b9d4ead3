# SPDX-License-Identifier: BSD-3-Clause
"""Equal parts of things that follow one another."""


def equal_part(count: int, part: int, parts: int) -> tuple[int, int]:
    """Return where a part of so many begins, and where it ends: that one is the next part's.

    It is the same as the core's `Share`.
    """
    return count * part // parts, count * (part + 1) // parts
