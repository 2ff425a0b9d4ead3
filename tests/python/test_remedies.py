# SPDX-License-Identifier: BSD-3-Clause
"""Which known word a mistaken one is told to mean."""

from __future__ import annotations

import pytest

from mpm3dpp.base.errors import nearest

BASES = ("gimp", "linear", "quadratic_bspline")


@pytest.mark.parametrize(
    ("word", "meant"),
    [("bspline", "quadratic_bspline"), ("Quadratic", "quadratic_bspline"), ("liner", "linear")],
)
def test_a_part_of_a_word_is_nearer_than_a_likeness(word: str, meant: str) -> None:
    assert nearest(word, BASES).startswith(f'did you mean "{meant}"?')


def test_what_is_like_none_gets_them_all() -> None:
    assert nearest("xyz", BASES) == "valid here: gimp, linear, quadratic_bspline"
