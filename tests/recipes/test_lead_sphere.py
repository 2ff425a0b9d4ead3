# SPDX-License-Identifier: BSD-3-Clause
"""A sphere of lead at 6.6 km/s through a plate of lead, as one of MPM3D-F90's samples has it.

MPM3D-F90 runs to 30 us in 755 steps, without a spall strength; of 513 kJ of kinetic energy 436 are
left then, in the energies that its run of the sample Lead_dtscale0p2 has written.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from mpm3dpp import Case, Simulation, load_case
from mpm3dpp.importers.write import write_case
from mpm_text import of

DECK = """\
mpm3d *** a sphere of lead on a plate of lead
! Unit: mm g N ms MPa
nbco 2
nbbo 2
nbmp 138278
nmat 1
spx -50 250
spy -80 80
spz -80 80
dcell 2.12
fixed 0 0 0 0 0 0
dtscale 0.2
endtime 0.030
outtime 0.002
musl on
jaum on
material
 1 sjcf 11.350d-3 22.4d3 0.42d0 12.0 125.0 1.0 0.0 1d-3 3.0
 seos 1 2 2.092d3 1.45 2.0 0
particle sphere 1
 1 13.5180d-3 1.06 -7.50 0 0 7
particle block 2
 1 13.5180d-3 1.06 0 -80 -80 6 151 151
velo
 body 1 6580.0 0.0 0.0
endv
endi
"""
KINETIC = 436.4509e3  # at 30 us, of MPM3D-F90 [J]

# The numerics in place of those that are imported: MUSL, linear, FLIP, a fifth of the step.
NUMERICS = {
    "default": ("", ""),
    "flip": ("[run]", 'transfer = "flip"'),
    "gimp": ("[grid]", 'basis = "gimp"'),
}
EXPECTED = {
    "imported": ("linear", "flip", "musl"),
    "default": ("quadratic_bspline", "aflip", "usf"),
    "flip": ("quadratic_bspline", "flip", "musl"),
    "gimp": ("gimp", "flip", "musl"),
}
IMPORTED = re.compile(r"^(basis|scheme|cfl|transfer) = .*\n", re.MULTILINE)


def case_of(folder: Path, numerics: str) -> Case:
    [file, *_] = write_case(of(DECK), folder / "lead.toml")
    if numerics != "imported":
        table, line = NUMERICS[numerics]
        text = IMPORTED.sub("", file.read_text())
        file.write_text(text.replace(f"{table}\n", f"{table}\n{line}\n", 1) if table else text)
    case = load_case(file)
    words = (case.grid.basis, case.run.transfer.word, case.run.scheme)
    assert words == EXPECTED[numerics]
    return case


@pytest.mark.slow
@pytest.mark.parametrize("numerics", ["imported", *NUMERICS])
def test_a_sphere_of_lead_through_a_plate(numerics: str, tmp_path: Path) -> None:
    """It runs to the end without a spall strength, and no bound of the energy makes any.

    MPM3D-F90 makes 2.2 % of the energy on its way. Of the kinetic energy here 2 to 3 % more are
    left without an affine transfer, and 3.2 % less with the default, whose numerics lose 5.5 % of
    the energy.
    """
    case = case_of(tmp_path, numerics)
    simulation = Simulation(case, threads=2)
    simulation.advance(10**6, case.run.end_time)
    assert simulation.time == pytest.approx(30e-6)
    row = dict(zip(simulation.core.history_columns, simulation.core.history().T, strict=True))
    start = row["kinetic"][0]
    assert row["kinetic"][-1] == pytest.approx(KINETIC, rel=0.035)
    for column in ("bounded", "energy_floor"):
        assert np.abs(row[column]).max() < 0.01 * start
    # In the first steps cells that both bodies fill take the difference of their velocities.
    assert np.abs(np.diff(row["numerical"])[10:]).max() < 0.01 * start
    # 0.044 to 0.056 with the default, 0.11 and more with the others: steps shorten as debris
    # opens (0064).
    assert row["dt"][1:-1].min() > 0.04 * row["dt"][1]
