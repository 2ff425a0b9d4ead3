# SPDX-License-Identifier: BSD-3-Clause
"""MPM3Dpp: impact and frictional contact of any number of deformable bodies.

>>> import mpm3dpp
>>> case = mpm3dpp.load_case("case.toml")
>>> mpm3dpp.run_case(case, "results/rings")
>>> results = mpm3dpp.open_results("results/rings")

What is named in `__all__` is loaded at first use, so that `import mpm3dpp` stays fast.
"""

from __future__ import annotations

import importlib
import sys

TYPE_CHECKING = False  # That of `typing`, which takes a while to import.
if TYPE_CHECKING:
    from typing import Any

    from . import shapes
    from .case import Case, Material, load_case
    from .case_body import Body
    from .case_grid import Grid, GridBox, GridDoubling, GridKeep, Walls
    from .case_parts import Contact, ContactPair, Output, Run, Viscosity
    from .detonation import Detonation
    from .errors import CaseError, RunError
    from .grains import GrainCentres, GrainLattice, GrainPacking, Grains
    from .io import open_results
    from .loads import Load
    from .materials import Eos, Failure, Strength
    from .motion import Motion
    from .particles import Particles
    from .run import run_case
    from .simulation import Simulation
    from .time_functions import TimeFunction

    __version__: str


class _CoreFinder:
    """Asks `processor.CoreFinder` for the core, and only then imports it."""

    @staticmethod
    def find_spec(name: str, path: Any = None, target: Any = None) -> Any:
        if name != f"{__name__}._core":
            return None
        from .processor import CoreFinder

        return CoreFinder.find_spec(name, path, target)


sys.meta_path.insert(0, _CoreFinder())

_HOMES = {
    "case": ("Case", "Material", "load_case"),
    "case_body": ("Body",),
    "case_grid": ("Grid", "GridBox", "GridDoubling", "GridKeep", "Walls"),
    "case_parts": ("Contact", "ContactPair", "Output", "Run", "Viscosity"),
    "detonation": ("Detonation",),
    "errors": ("CaseError", "RunError"),
    "grains": ("GrainCentres", "GrainLattice", "GrainPacking", "Grains"),
    "io": ("open_results",),
    "loads": ("Load",),
    "materials": ("Eos", "Failure", "Strength"),
    "motion": ("Motion",),
    "particles": ("Particles",),
    "run": ("run_case",),
    "simulation": ("Simulation",),
    "time_functions": ("TimeFunction",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "Body",
    "Case",
    "CaseError",
    "Contact",
    "ContactPair",
    "Detonation",
    "Eos",
    "Failure",
    "GrainCentres",
    "GrainLattice",
    "GrainPacking",
    "Grains",
    "Grid",
    "GridBox",
    "GridDoubling",
    "GridKeep",
    "Load",
    "Material",
    "Motion",
    "Output",
    "Particles",
    "Run",
    "RunError",
    "Simulation",
    "Strength",
    "TimeFunction",
    "Viscosity",
    "Walls",
    "__version__",
    "load_case",
    "open_results",
    "run_case",
    "shapes",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import PackageNotFoundError, version

        try:
            return version("mpm3dpp")
        except PackageNotFoundError:
            return "0+unknown"
    if name in ("io", "shapes"):
        return importlib.import_module(f".{name}", __name__)
    if name in _HOME:
        return getattr(importlib.import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
