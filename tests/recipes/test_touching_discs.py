# SPDX-License-Identifier: BSD-3-Clause
"""Coarse versions of the verification problems with discs: laws of the answers, same bits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from verification import chain, rolling


def test_the_acceleration_of_slipping_is_that_of_the_equations_of_motion() -> None:
    """Forces and torque of two sliding contacts, solved as a linear system."""
    mu, s, c = 0.5, math.sin(rolling.TILT), math.cos(rolling.TILT)
    # x and y of N1 and N2, with frictions that push against the surface of the disc.
    forces = np.array([[s - mu * c, -s - mu * c], [c + mu * s, c - mu * s]])
    weight = rolling.GRAVITY  # of one kilogram
    normal = np.linalg.solve(forces, [0.0, weight])
    assert (normal > 0.0).all()  # it stays on both
    spin_up = mu * normal.sum() * rolling.RADIUS / (0.5 * rolling.RADIUS**2)
    assert rolling.slip_rate(mu) == pytest.approx(spin_up, rel=1e-12)


def test_the_chain_of_masses_keeps_momentum_and_does_not_depend_on_its_step() -> None:
    """The trapezoidal rule takes the piston's force to its curvature: 1e-4 of the impulse."""
    times = np.linspace(0.0, 0.01, 2001)
    v, force = chain.chain_of_masses(times)
    impulse = np.sum((force[1:] + force[:-1]) / 2 * np.diff(times))
    assert chain.MASS * v[-1].sum() == pytest.approx(impulse, rel=1e-4)
    finer, _ = chain.chain_of_masses(np.linspace(0.0, 0.01, 4001))
    assert np.abs(finer[-1] - v[-1]).max() < 1e-4 * chain.SPEED


def test_the_law_of_the_contact_is_johnsons() -> None:
    """At P = pi E' R / 400 the contact is a tenth of the radius wide: 2 ln 40 - 1."""
    force = np.array([math.pi * chain.PLATE * chain.RADIUS / 400])
    wanted = 2 * (2 * math.log(40.0) - 1.0) * chain.RADIUS / 400
    assert chain.approach(force)[0] == pytest.approx(wanted, rel=1e-12)


def test_a_coarse_column_is_the_same_on_two_threads() -> None:
    one, two = (chain.column("musl", "gimp", 6, 6e-3, threads=k) for k in (1, 2))
    assert one[0].tobytes() == two[0].tobytes()
    assert len(one[1].core.contact_pairs()) >= 3  # the plate and two or more discs have met
    a, b = one[1].history(), two[1].history()
    assert all(a[name].tobytes() == b[name].tobytes() for name in a)
