# SPDX-License-Identifier: BSD-3-Clause
"""H1: grains that run through a hopper, the rate against Beverloo's law."""

from __future__ import annotations

import runpy

from .examples import EXAMPLES, case_of
from .figure import Figure, judge, report
from .scene import Failed

FOLDER = "05_hopper"


def hopper(
    scheme: str, dimension: int, basis: str, until: float = 0.6, wide: float = 9.0,
    narrow: float = 6.0,
) -> list[Figure]:  # fmt: skip
    """Return the rates through two outlets, in grain diameters, of the small hopper.

    Raises:
        Failed: less than a tenth of the grains has left.
    """
    tools = runpy.run_path(str(EXAMPLES / FOLDER / "discharge.py"))
    case = case_of(FOLDER, scheme, basis, "case_small.toml")
    found = [
        tools["discharge"](tools["with_outlet"](case, width), until) for width in (wide, narrow)
    ]
    if any(run.left[-1] < 0.1 * run.total for run in found):
        raise Failed("less than a tenth of the grains has left")
    rates = [run.rate() for run in found]
    return [
        judge("H1", "rate through 9 d over Beverloo's", rates[0] / found[0].beverloo()),
        judge("H1", "rate through 6 d over Beverloo's", rates[1] / found[1].beverloo()),
        judge("H1", "ratio of the two rates", rates[0] / rates[1]),
        report("density of the bed", found[0].density, "kg/m^3"),
    ]
