# SPDX-License-Identifier: BSD-3-Clause
"""The middle of points: exact to the last bits, and the same however they are ordered."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from mpm3dpp.base.mean import mass_centre, middle


@pytest.mark.parametrize("scale", [1e-9, 1.0, 3e7])
def test_middle(scale: float) -> None:
    points = scale * np.random.default_rng(5).normal(0.3, 1.0, (997, 3))
    found = middle(points)
    for d in range(3):
        exact = sum(map(Fraction, points[:, d])) / len(points)
        # Half a unit of 2^-52 of the largest coordinate each, and the rounding of the mean.
        assert abs(Fraction(found[d]) - exact) <= 2.0**-52 * np.abs(points).max()
    turned = np.random.default_rng(6).permutation(points)
    assert (middle(turned) == found).all()
    assert (middle(-points) == -found).all()
    assert (middle(points[:, [2, 0, 1]]) == found[[2, 0, 1]]).all()


def test_nothing_but_zeros() -> None:
    assert (middle(np.zeros((3, 2))) == 0.0).all()


def test_weights() -> None:
    points, volumes = np.array([[0.0, 0.0], [1.0, 2.0]]), np.array([1.0, 3.0])
    assert (mass_centre(points, volumes) == [0.75, 1.5]).all()
    assert (mass_centre(points, np.ones(2)) == [0.5, 1.0]).all()
