# SPDX-License-Identifier: BSD-3-Clause
"""In a package with several builds of the core (`MPM_NATIVE=OFF`) all give the same results.

A package with one core has nothing to compare; `cmake --preset portable` builds one with three.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mpm3dpp
from cases import BASES
from mpm3dpp import _core
from mpm3dpp.base.processor import LEVELS, processor_flags

HERE = Path(mpm3dpp.__file__).parent
PRESENT = [level for level in LEVELS if list(HERE.glob(f"_core_{level.replace('-', '_')}.*"))]
USABLE = [level for level in PRESENT if LEVELS[level] <= processor_flags()]
STEPS = {2: 120, 3: 60}
# Rounding, after so many steps of blocks that meet with friction.
NEAR = 1e-9

_RUN = """
import sys
import numpy as np
from cases import three_blocks
from mpm3dpp import Material, Simulation, _core
dimension, basis, file = int(sys.argv[1]), sys.argv[2], sys.argv[3]
case = three_blocks(dimension, "musl", grid={"basis": basis})
if sys.argv[5] == "flows":  # Soft, so that it yields; m < 1, so that it heats at once.
    law = {"E": 1e6, "nu": 0.3, "A": 500.0, "B": 2e3, "n": 0.3, "C": 0.02, "m": 0.55}
    law |= {"T_melt": 310.0, "cp": 1.0}
    solid = Material(density=1000.0, strength={"johnson_cook": law})
    case = case.model_copy(update={"material": {**case.material, "solid": solid}})
simulation = Simulation(case, threads=1)
simulation.advance(int(sys.argv[4]))
core = simulation.core
names = ("position", "velocity", "stress")
columns = {n: np.concatenate([core.column(b, n) for b in range(core.body_count)]) for n in names}
np.savez(file, lanes=_core.build_info()["lanes"], **columns)
"""


def columns_of(
    level: str, dimension: int, basis: str, law: str, folder: Path
) -> dict[str, np.ndarray]:
    """Return position, velocity and stress of all particles, and the lanes, of a level's run."""
    file = folder / f"{level}.npz"
    words = [sys.executable, "-c", _RUN, str(dimension), basis, str(file), str(STEPS[dimension])]
    words.append(law)
    paths = [str(Path(__file__).parents[1]), str(HERE.parent)]
    environment = {**os.environ, "MPM3DPP_ISA": level, "PYTHONPATH": os.pathsep.join(paths)}
    subprocess.run(words, env=environment, check=True)
    with np.load(file) as found:
        return dict(found)


@pytest.mark.skipif(len(USABLE) < 2, reason="this package has one core that runs here")
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("law", ["elastic", "flows"])
def test_levels_agree(dimension: int, basis: str, law: str, tmp_path: Path) -> None:
    """To rounding; to the bit where a multiplication and addition are rounded once, or nowhere."""
    unfused = set() if "-DMPM_SAME_BITS" in _core.build_info()["flags"] else {"x86-64"}
    found = {level: columns_of(level, dimension, basis, law, tmp_path) for level in USABLE}
    assert len({int(one.pop("lanes")) for one in found.values()}) == len(USABLE)  # They differ.
    first = next((level for level in USABLE if level not in unfused), USABLE[0])
    for level in [level for level in USABLE if level != first]:
        for name, values in found[first].items():
            if level not in unfused:
                assert values.tobytes() == found[level][name].tobytes(), (level, name)
            near = NEAR * np.abs(values).max()
            np.testing.assert_allclose(found[level][name], values, rtol=0.0, atol=near)
