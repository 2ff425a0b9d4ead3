# SPDX-License-Identifier: BSD-3-Clause
"""Coarse versions of the verification problems with discs: laws of the answers, same bits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from verification import chain, rolling, runout


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


class Deposit(runout.Column):
    """Discs of the mean radius at given places."""

    def __init__(self, places: np.ndarray) -> None:
        super().__init__(None, np.full(len(places), runout.RADIUS), 0.1)  # type: ignore[arg-type]
        object.__setattr__(self, "places", places)

    def centres(self) -> np.ndarray:
        return self.places  # type: ignore[attr-defined]


def test_the_front_is_where_less_than_a_row_of_discs_is_left() -> None:
    """Two rows of 20 touching discs, then single ones with gaps: it ends with the rows.

    The thickness is that within three diameters: the front may be half of that off.
    """
    d = 2 * runout.RADIUS
    rows = [[(k + 0.5) * d, (j + 0.5) * d] for j in range(2) for k in range(20)]
    ahead = [[(21.5 + 2.5 * k) * d, 0.5 * d] for k in range(4)]
    deposit = Deposit(np.array(rows + ahead))
    assert deposit.front() == pytest.approx(20 * d, abs=1.5 * d)
    assert deposit.hanging_together() == pytest.approx(20 * d, rel=1e-12)
    assert deposit.height() == pytest.approx(2 * d, rel=1e-12)


def test_discs_behind_a_gate_are_the_same_on_two_threads() -> None:
    columns = [runout.build("musl", "gimp", 60, 1.0, 3.0, threads=k) for k in (1, 2)]
    for column in columns:
        column.scene.run(0.03)
    one, two = (np.concatenate([c.scene.x(k) for k in range(60)]) for c in columns)
    assert one.tobytes() == two.tobytes()
    assert len(columns[0].scene.core.contact_pairs()) > 0
    rows = columns[0].scene.history()
    assert np.abs(rows["residual"]).max() < 1e-11 * rows["external"].max()
