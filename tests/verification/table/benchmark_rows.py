# SPDX-License-Identifier: BSD-3-Clause
"""Problems of the table that are benchmarks of `mpm3dpp validate`; a splash, a bar that tears."""

from __future__ import annotations

from collections.abc import Callable

from mpm3dpp import Case, CaseError
from mpm3dpp.validate.benchmark import benchmarks
from mpm3dpp.validate.judge import judge

from ..numerics import AUTO, Numerics
from ..scene import Failed
from .measures import Measured, Watched

BENCHMARKS = {
    "hits": ("three_hits", "6 cells", "energy left over that of the fall"),
    "drop": ("bouncing_ball", "e = 1", "speed after the hit over that before"),
    "roll": ("rolls_down", "5 cells a radius", "speed [m/s]"),
    "torsion": ("twisted_rod", "", "period off over the period"),
    "gas": ("gas_into_vacuum", "", "speed where the wall was, over c0"),
    "hardening": ("expanding_ring", "", "mean plastic strain"),
}
"""Of each row the benchmark, its variant and its figure."""

SPLASH = """
[grid]
dimension = 2
cell_size = "2 mm"
box = { lower = ["-200 mm", 0], upper = ["200 mm", "100 mm"], walls = { y_min = "contact" } }
[run]
end_time = "0.03 s"
[material.water]
density = 1000
strength = { fluid = {} }
eos = { tait = { c0 = 20 } }
[body.drop]
material = "water"
shape = { disc = { centre = [0, "20.5 mm"], radius = "20 mm" } }
velocity = [0, "-1 m/s"]
"""
TORN = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "4.8 ms"
[material.brittle]
density = 1000
strength = { elastic = { E = "10 MPa", nu = 0 } }
failure = { principal_stress = { limit = "40 kPa" } }
[body.bar]
material = "brittle"
shape = { box = { lower = ["-12 mm", 0], upper = ["12 mm", "6 mm"] } }
velocity = [{ expression = "x / abs(x)" }, 0]
"""


def _of_benchmark(name: str) -> Callable[[str, str], Measured]:
    benchmark, variant, title = BENCHMARKS[name]

    def problem(numerics: str, _scheme: str) -> Measured:
        def frame(case: Case) -> Case:
            if numerics != AUTO:
                case.contact.restitution = 1.0  # Only surfaces have one.
                Numerics.named(numerics).give_case(case)
                case.complete_and_check()
            return case

        [found] = benchmarks([benchmark])
        try:
            figures = judge(found, threads=1, only=(variant,), change=frame)
        except CaseError as error:
            raise Failed(str(error)) from None
        [one] = (figure for figure in figures if figure.figure.title == title)
        return Measured((one.value - one.answer) / (abs(one.answer) or 1.0))

    problem.__name__, problem.__doc__ = name, f"{title}, {variant or 'its only run'}"
    return problem


def splash(name: str, scheme: str) -> Measured:
    """A drop of water falls on a floor: energy left, with that of heat."""
    run = Watched(Case.from_text(SPLASH), name, scheme)
    return run.measured(run.over_start("kinetic", "internal", "viscous") - 1, "drop")


def torn(name: str, scheme: str) -> Measured:
    """A brittle bar whose halves fly apart: energy left."""
    run = Watched(Case.from_text(TORN), name, scheme)
    return run.measured(run.over_start("kinetic", "internal") - 1, "bar")


MORE: dict[str, Callable[[str, str], Measured]] = {
    **{name: _of_benchmark(name) for name in BENCHMARKS},
    "splash": splash,
    "torn": torn,
}
