# SPDX-License-Identifier: BSD-3-Clause
"""Inputs of MPM3D-F90 beside its own results. What misses its tolerance must stay as it is known.

A range is what we reach, never a reason to change a tolerance; docs/how-to/bring-mpm3d-files.md and
the comments here say why.
"""

import math

import pytest

from verification.mpm3d import compare, imported, reference, run

# Difference that we reach in figures that miss: (case, figure) to (lowest, highest).
REACHED = {
    # 0.9 % of the bar's energy is left, and it depends on the time step: -1.9 % with as many steps
    # as MPM3D-F90 made, see below; -3.5 % with the 647 that its factor gives here, since artificial
    # viscosity bounds the step too; -4.0 and -4.2 % with 1,292 and 2,583. Ours has settled, theirs
    # is of its time step.
    ("Taylor", "kinetic energy"): (-0.04, -0.03),
    # The burn, which rises over 1.5 cells: with it 1.5 cells earlier -1.2 %.
    ("TNT3D", "kinetic energy"): (-0.051, -0.041),
    ("TNT3D", "largest kinetic energy"): (-0.051, -0.041),
    # The slope sways at rest, between 5 and 55 kJ, MPM3D-F90's between 4 and 52: the end is one
    # moment of that, near the least. The mean says how strongly; ours sways more along the slope.
    ("Slopefail", "kinetic energy"): (0.0, 0.5),
    ("Slopefail", "mean kinetic energy from 10"): (0.05, 0.085),
    # MPM3D-F90 seems to have no viscosity at all for hiex. At 13.75 us, before the front is out,
    # kinetic energy [mJ]: exact 30.2, MPM3D-F90 44.3, ours 18.0, ours without viscosity 40.2;
    # momentum [g m/s]: 0.0485, 0.0354, 0.0250, 0.0344. Both codes err, as points cross cells of the
    # linear basis; with gimp a tenth of the length comes within 4 % and 1 % of the exact answer.
    ("Deto1k", "kinetic energy"): (-0.56, -0.49),
    ("Deto1k", "largest kinetic energy"): (-0.56, -0.45),
    ("Deto1k", "internal energy"): (0.06, 0.085),
}
SLOW = ("Taylor", "Slopefail", "Deto1k")


def cases() -> list:
    return [
        pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in reference()
    ]


@pytest.mark.parametrize("name", cases())
def test_beside_mpm3d(name):
    simulation, history = run(imported(name))
    wrong = []
    for row in compare(name, simulation, history):
        known = REACHED.get((name, row.name))
        if row.passed and known:
            wrong.append(f"{row.cells()}: no longer misses; take it out of REACHED")
        elif not row.passed and not (known and known[0] <= row.difference <= known[1]):
            wrong.append(row.cells())
    assert not wrong, "\n".join(wrong)


@pytest.mark.slow
def test_taylor_bar_with_as_many_steps():
    """With the time step of MPM3D-F90 all of its tolerances are met, kinetic energy too."""
    case = imported("Taylor")
    case.run.cfl = 0.83
    simulation, history = run(case)
    assert simulation.step == pytest.approx(reference()["Taylor"]["steps"], rel=0.01)
    rows = [row for row in compare("Taylor", simulation, history) if row.tolerance is not None]
    assert rows
    assert all(row.passed for row in rows), "\n".join(row.cells() for row in rows)


def test_momentum_of_two_cubes_in_contact():
    """Contact acts on both bodies alike: their momenta cancel to rounding."""
    simulation, history = run(imported("two128k_contact"))
    size = reference()["two128k_contact"]["mass"] * 1e-3 * 50.0
    for axis in "xyz":
        assert abs(history[f"momentum_{axis}"]).max() < 1e-12 * size
    assert simulation.core.contact_pairs()


def test_taylor_bar_stands_as_given():
    """The positions of the points are those of the file; its box and masses too."""
    case = imported("Taylor")
    particles = case.body["body_1"].particles
    assert particles is not None and particles.volumes is not None
    assert len(particles.positions) == 21172
    mass = 8930 * math.fsum(particles.volumes)
    assert mass == pytest.approx(1e-3 * reference()["Taylor"]["mass"], rel=1e-6)  # 32 bits there
    assert particles.positions[:, 2].max() == pytest.approx(0.02527)
