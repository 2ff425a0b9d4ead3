# SPDX-License-Identifier: BSD-3-Clause
"""The numbers of a case as the core wants them."""

from __future__ import annotations

import math
from typing import Any

from mpm3dpp import _core
from mpm3dpp.base.settings import fill_core_table
from mpm3dpp.case.case import Case


def core_settings(case: Case, threads: int) -> _core.Settings:
    """Return a case's numbers as the core wants them."""

    def three(values: Any, fill: Any) -> list[Any]:
        return [*values, fill, fill, fill][:3]

    settings = _core.Settings()
    for name in ("grid", "run", "contact"):
        fill_core_table(getattr(settings, name), getattr(case, name))
    fill_core_table(settings.run.transfer, case.run.transfer).word = case.run.transfer.word
    if case.run.settle is not None:
        settings.run.settle = fill_core_table(_core.SettleSettings(), case.run.settle)
    given, grid = case.grid, settings.grid
    grid.origin = three(given.lower, 0.0)
    grid.box_cells = three(given.box_cells, 0) if given.box_cells else [0, 0, 0]
    grid.walls = given.walls
    grid.wall_friction = given.wall_friction(case.contact.friction)
    grid.outflow = given.outflow_box is not None
    grid.outflow_lower = three(given.kept[0], -math.inf)
    grid.outflow_upper = three(given.kept[1], math.inf)
    if given.coarsening is not None:
        grid.coarsening = fill_core_table(_core.CoarseningSettings(), given.coarsening)
    settings.execution.threads = threads
    return settings
