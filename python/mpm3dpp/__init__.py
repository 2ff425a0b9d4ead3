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

    from mpm3dpp import shapes
    from mpm3dpp.base.damping import Damping, MaterialDamping
    from mpm3dpp.base.errors import CaseError, RunError
    from mpm3dpp.base.time_functions import TimeFunction
    from mpm3dpp.case.body import Body
    from mpm3dpp.case.box import GridBox, Walls
    from mpm3dpp.case.case import Case, Material, load_case
    from mpm3dpp.case.detonation import Detonation
    from mpm3dpp.case.grid import Grid, GridCoarsening, GridOutflowBox
    from mpm3dpp.case.loads import Load
    from mpm3dpp.case.motion import Motion
    from mpm3dpp.case.particles import Particles
    from mpm3dpp.case.parts import Contact, ContactPair, Output, Run, Viscosity
    from mpm3dpp.case.probe import Probe, ProbeRegion
    from mpm3dpp.case.stop import Stop
    from mpm3dpp.grains import GrainCentres, GrainLattice, GrainPacking, Grains
    from mpm3dpp.io import open_results
    from mpm3dpp.materials import Eos, Failure, Strength
    from mpm3dpp.reports import report
    from mpm3dpp.run.record import record
    from mpm3dpp.run.run import run_case
    from mpm3dpp.run.simulation import Simulation

    __version__: str


class _CoreFinder:
    """Asks `processor.CoreFinder` for the core, and only then imports it."""

    @staticmethod
    def find_spec(name: str, path: Any = None, target: Any = None) -> Any:
        if name != f"{__name__}._core":
            return None
        from mpm3dpp.base.processor import CoreFinder

        return CoreFinder.find_spec(name, path, target)


sys.meta_path.insert(0, _CoreFinder())

_HOMES = {
    "base.damping": ("Damping", "MaterialDamping"),
    "base.errors": ("CaseError", "RunError"),
    "base.time_functions": ("TimeFunction",),
    "case": ("Case", "Material", "load_case"),
    "case.body": ("Body",),
    "case.box": ("GridBox", "Walls"),
    "case.detonation": ("Detonation",),
    "case.grid": ("Grid", "GridCoarsening", "GridOutflowBox"),
    "case.loads": ("Load",),
    "case.motion": ("Motion",),
    "case.particles": ("Particles",),
    "case.probe": ("Probe", "ProbeRegion"),
    "case.stop": ("Stop",),
    "case.parts": ("Contact", "ContactPair", "Output", "Run", "Viscosity"),
    "grains": ("GrainCentres", "GrainLattice", "GrainPacking", "Grains"),
    "io": ("open_results",),
    "materials": ("Eos", "Failure", "Strength"),
    "reports": ("report",),
    "run.record": ("record",),
    "run.run": ("run_case",),
    "run.simulation": ("Simulation",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}
_FORMERLY = {"GridDoubling": "GridCoarsening", "GridKeep": "GridOutflowBox"}  # For this release.

__all__ = [
    "Body",
    "Case",
    "CaseError",
    "Contact",
    "ContactPair",
    "Damping",
    "Detonation",
    "Eos",
    "Failure",
    "GrainCentres",
    "GrainLattice",
    "GrainPacking",
    "Grains",
    "Grid",
    "GridBox",
    "GridCoarsening",
    "GridOutflowBox",
    "Load",
    "Material",
    "MaterialDamping",
    "Motion",
    "Output",
    "Particles",
    "Probe",
    "ProbeRegion",
    "Run",
    "RunError",
    "Simulation",
    "Stop",
    "Strength",
    "TimeFunction",
    "Viscosity",
    "Walls",
    "__version__",
    "load_case",
    "open_results",
    "record",
    "report",
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
    if name in _FORMERLY:
        import warnings

        now = _FORMERLY[name]
        what = f"mpm3dpp.{name} is named mpm3dpp.{now} now; the next release will not know it"
        warnings.warn(what, DeprecationWarning, stacklevel=2)
        return __getattr__(now)
    if name in _HOME:
        return getattr(importlib.import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
