# SPDX-License-Identifier: BSD-3-Clause
"""Where a material fails in a test, by which of its models, and under what stress."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mpm3dpp.case.case import Material
from mpm3dpp.materials.chosen import Failure
from mpm3dpp.plots.labels import scaled

STRESS = {"shear": "stress_xy", "triaxial": "deviator"}
"""The stress that a test is about, where it is not stress_xx."""


@dataclass(frozen=True)
class Failed:
    """A failure.

    Attributes:
        row: the first one that has failed; in the row before the stress was still whole.
        before, strain: strains of the row before and of this one, between which it failed.
        column, stress: name of the test's stress, and its value in the row before [Pa].
        models: those that failed first; more than one only if they did in the same step.
    """

    row: int
    before: float
    strain: float
    column: str
    stress: float
    models: list[Failure]

    def sentence(self) -> str:
        """Return where it failed, by what, and what becomes of it."""
        models = " and ".join(_in_words(model) for model in self.models)
        actions = " and ".join(sorted({model.action for model in self.models}))
        name = self.column.replace("_", " ")
        return (
            f"fails between strain {self.before:.6g} and {self.strain:.6g}, at a {name} of "
            f"{scaled(self.stress, 'Pa', 6)}, by {models}; action {actions}"
        )

    def table(self) -> dict[str, object]:
        """Return the same for JSON."""
        return {
            "strain": [self.before, self.strain],
            self.column: self.stress,
            "models": [model.model for model in self.models],
        }


def first_failure(
    material: Material,
    test: str,
    columns: dict[str, np.ndarray],
    again: Callable[[Material], dict[str, np.ndarray]],
) -> Failed | None:
    """Return the first failure of a test, or None.

    Until something fails the path is the same whatever the failure models, so each of several is
    driven along it alone and those count that fail in the same row.

    Args:
        material: what was tested.
        test: its name.
        columns: of the test, with `strain`.
        again: drives another material along the same motion.
    """
    row = _first_row(columns)
    if row is None:
        return None
    models = list(material.failure)
    if len(models) > 1:
        alone = [again(material.model_copy(update={"failure": [one]})) for one in models]
        found = zip(models, alone, strict=True)
        models = [model for model, own in found if _first_row(own) == row]
    name, strain = STRESS.get(test, "stress_xx"), columns["strain"]
    before = max(row - 1, 0)
    stress = float(columns[name][before])
    return Failed(row, float(strain[before]), float(strain[row]), name, stress, models)


def no_failure(material: Material, columns: dict[str, np.ndarray]) -> str:
    """Return that a material with failure models has not failed, and how near it is."""
    models = " nor by ".join(_in_words(model) for model in material.failure)
    damage = f"; damage {columns['damage'][-1]:.4g} at the end" if "damage" in columns else ""
    return f"does not fail by {models}{damage}"


def _first_row(columns: dict[str, np.ndarray]) -> int | None:
    rows = np.flatnonzero(columns.get("failed", np.zeros(0)) > 0.0)
    return int(rows[0]) if len(rows) else None


def _in_words(failure: Failure) -> str:
    limit = failure.parameters.get("limit")
    return failure.model if limit is None else f"{failure.model} (limit = {limit:g})"
