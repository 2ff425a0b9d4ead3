# SPDX-License-Identifier: BSD-3-Clause
"""Which problems are run, with which scheme, dimension, basis and resolution."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from mpm3dpp.case import choices

from . import (
    bars,
    chain,
    column,
    discs,
    examples,
    grains,
    groups,
    hopper,
    in_body,
    in_body_contact,
    incline,
    point,
    rolling,
    runout,
    silo,
    written,
)
from .figure import Figure
from .numerics import MATERIAL, UPDATED
from .scene import Failed

BASES = ("linear", "gimp")
LATTICE = {"fill": "lattice"}


@dataclass(frozen=True)
class Run:
    """One run of a problem.

    Attributes:
        problem: "E1", ...; `--only` chooses by it.
        make: the function that runs it.
        scheme, dimension, basis: of the run.
        options: further arguments of `make`.
        slow: longer than a few seconds.
    """

    problem: str
    make: Callable[..., list[Figure]]
    scheme: str
    dimension: int
    basis: str
    options: dict[str, Any] = field(default_factory=dict)
    slow: bool = False

    @property
    def title(self) -> str:
        """Name for a table and for pytest."""
        words = [self.problem, self.make.__name__, self.scheme, f"{self.dimension}D", self.basis]
        return " ".join([*words, *(f"{k}={v}" for k, v in self.options.items())])

    def figures(self) -> tuple[list[Figure], str, float]:
        """Run; return the figures, why it stopped ("" if it did not), and the time it took [s]."""
        begin, stopped, figures = time.monotonic(), "", []
        try:
            if self.make is point.simple_shear:
                figures = point.simple_shear(**self.options)
            else:
                figures = self.make(self.scheme, self.dimension, self.basis, **self.options)
        except Failed as error:
            stopped = str(error)
        return figures, stopped, time.monotonic() - begin


def _runs() -> Iterator[Run]:
    both = ("musl", "usf")
    for basis in BASES:
        for scheme in (*both, "usl"):
            for dimension in (2, 3):
                for cells in (13, 26):
                    yield Run("E1", column.vibration, scheme, dimension, basis, {"cells": cells})
        for scheme in both:
            yield Run("E11", column.under_gravity, scheme, 2, basis)
            for cells in (50, 100, 200):
                yield Run("E2", bars.two_bars, scheme, 2, basis, {"cells": cells})
            yield Run("E2", bars.two_bars, scheme, 2, basis, {"cells": 100, "speed": 0.1})
            for cells in (50, 200):
                yield Run("rod", bars.rod_energy, scheme, 2, basis, {"cells": cells})
            yield Run("E2b", bars.unequal_bars, scheme, 2, basis)
            yield Run("E9b", bars.five_bars, scheme, 2, basis, {"cells": 100})
            yield Run("E9b", bars.five_bars, scheme, 2, basis, {"cells": 200})
            for dimension in (2, 3):
                yield Run("E3", point.rigid_translation, scheme, dimension, basis)
                yield Run("E3", point.free_fall, scheme, dimension, basis)
            for cells in (40, 80):
                yield Run("E5", discs.sulsky_discs, scheme, 2, basis, {"cells": cells})
            yield Run("E5", discs.sulsky_discs, scheme, 2, basis, {"model": "elastic"})
            yield Run("E7", discs.first_touch, scheme, 2, basis)
            yield Run("E8", incline.sliding_block, scheme, 2, basis)
            yield Run("E8", incline.sticking_block, scheme, 2, basis)
            yield Run("C4", incline.infinite_slope, scheme, 2, basis)
            yield Run("C5", rolling.rolling_on_discs, scheme, 2, basis, {"cells": 8})
            yield Run("C6", chain.disc_column, scheme, 2, basis)
            yield Run("oblique", groups.oblique_impact, scheme, 2, basis)
            yield Run("oblique", groups.oblique_impact, scheme, 2, basis, {"slip": 0.05})
            yield Run("E9", incline.rolling, scheme, 2, basis, {"cells": 8})
            yield Run("E9b", groups.three_discs, scheme, 2, basis)
            yield Run("E9b", groups.many_bodies, scheme, 2, basis)
        yield Run("E11", column.under_gravity, "musl", 3, basis)
        yield Run("E2", bars.two_bars, "musl", 3, basis)
        yield Run("E2", bars.two_bars, "usl", 2, basis)
        yield Run("E5", discs.sulsky_discs, "usl", 2, basis)
        yield Run("E7", discs.first_touch, "musl", 2, basis, {"detection": "velocity"})
        yield Run("oblique", groups.oblique_impact, "musl", 3, basis)
        for bodies in (3, 5, 50):
            more = {"bodies": bodies, "steps": 500}
            yield Run("E9b", groups.many_bodies, "musl", 2, basis, more)
        yield Run("E9b", groups.many_bodies, "musl", 3, basis, {"bodies": 5, "steps": 300})
        yield Run("E9b", groups.renumbering, "musl", 2, basis)
        yield Run("E9b", groups.renumbering, "musl", 3, basis, {"steps": 100})
        for factor in (0.1, 0.9):
            yield Run("rod", bars.rod_energy, "musl", 2, basis, {"cells": 200, "factor": factor})
    for scheme in both:
        yield Run("S1", examples.plate_impact, scheme, 2, "gimp")
        yield Run("S2", examples.plate_impact, scheme, 2, "gimp", {"flyer": "6061-T6"})
        yield Run("S1", examples.plate_impact, scheme, 2, "gimp", {"speed": 2000.0})
        fast = {"flyer": "6061-T6", "speed": 2000.0}
        yield Run("S2", examples.plate_impact, scheme, 2, "gimp", fast)
        yield Run("S3", examples.sod_tube, scheme, 2, "gimp")
        yield Run("S5", examples.spall, scheme, 2, "gimp")
    yield Run("E4", point.simple_shear, "-", 3, "-")
    for more in ({}, LATTICE):
        yield Run("E3", written.spinning_disc, "musl", 2, "gimp", {"cells": 10} | more)
        yield Run("E3", written.spinning_disc, "musl", 2, "gimp", {"cells": 10, "points": 3} | more)
        yield Run("E9", written.rolling_disc, "musl", 2, "gimp", {"cells": 8} | more)
    yield from _slow_runs()


def _slow_runs() -> Iterator[Run]:
    for cells in (10, 20):
        yield Run("C1", grains.hertz_wall, "musl", 3, "gimp", {"cells": cells}, slow=True)
    for more in ({}, LATTICE):
        for cells in (10, 20):
            filled = {"cells": cells} | more
            yield Run("C1", written.hertz_spheres, "musl", 3, "gimp", filled, slow=True)
        yield Run("E3", written.spinning_disc, "musl", 2, "gimp", {"cells": 20} | more, slow=True)
        filled = {"cells": 20, "points": 3} | more
        yield Run("E3", written.spinning_disc, "musl", 2, "gimp", filled, slow=True)
        yield Run("E9", written.rolling_disc, "musl", 2, "gimp", {"cells": 16} | more, slow=True)
    for cells in (16, 32):
        yield Run("C5", rolling.rolling_on_discs, "musl", 2, "gimp", {"cells": cells}, slow=True)
    for cells in (10, 40):
        yield Run("C6", chain.disc_column, "musl", 2, "gimp", {"cells": cells}, slow=True)
    for aspect in (1.0, 2.0):
        yield Run("C7", runout.run_out, "musl", 2, "gimp", {"aspect": aspect}, slow=True)
    yield Run("C3", silo.janssen, "musl", 2, "gimp", slow=True)
    yield Run("C2", grains.hertz_chain, "musl", 3, "gimp", {"cells": 10}, slow=True)
    yield Run("S4", examples.tnt_slab, "musl", 2, "gimp", slow=True)
    yield Run("W1", examples.dam_break, "musl", 2, "gimp", slow=True)
    yield Run("G1", examples.sand_column, "musl", 2, "gimp", slow=True)
    yield Run("H1", hopper.hopper, "musl", 2, "gimp", slow=True)
    yield Run("Taylor", examples.taylor_bar, "musl", 3, "gimp", slow=True)
    yield Run("Taylor", examples.taylor_bar, "musl", 3, "linear", slow=True)
    for basis in BASES:
        for scheme in ("musl", "usf"):
            for cells in (10, 20):
                yield Run("E3", point.spin, scheme, 2, basis, {"cells": cells, "factor": 0.2}, True)
            for size in (2.5, 1.25):
                more = {"cell_mm": size, "factor": 0.2}
                yield Run("E6", discs.rings, scheme, 2, basis, more, True)
        more = {"cell_mm": 0.8, "factor": 0.125}
        yield Run("E6", discs.rings, "musl", 2, basis, more, True)
        yield Run("E8", incline.sliding_block, "musl", 2, basis, {"across": 16}, True)
        for cells in (16, 32):
            yield Run("E9", incline.rolling, "musl", 2, basis, {"cells": cells}, True)
        yield Run("E9", incline.rolling, "musl", 3, basis, {"cells": 5}, True)
        for speed in (1.0, 4.0):
            more = {"cells": 6, "speed": speed, "factor": 0.5}
            yield Run("E10", groups.offset_spheres, "musl", 3, basis, more, True)
        for cells in (10, 20) if basis == "gimp" else (10,):
            more = {"cells": cells, "speed": 1.0, "factor": 0.5, "offsets": ("0.5",)}
            yield Run("E10", groups.offset_spheres, "musl", 3, basis, more, True)


def _in_space(runs: list[Run]) -> Iterator[Run]:
    """Return what has been run with GIMP, FLIP and MUSL once more, as a case gets it in space."""
    for run in runs:
        options = {key: value for key, value in run.options.items() if key != "factor"}
        lattice = options.get("fill") == LATTICE["fill"]
        if (run.basis, run.scheme) == ("gimp", "musl") and not lattice:
            scheme = choices.AFFINE["scheme"]
            yield replace(run, basis=UPDATED, scheme=scheme, options=options)


def _with_impulses() -> Iterator[Run]:
    """Return small patches of contact, and what rolls, without springs (decision 0053)."""
    numerics, scheme = f"{UPDATED}~{choices.OTHER_RESPONSE}", choices.AFFINE["scheme"]
    yield Run("C5", rolling.rolling_on_discs, scheme, 2, numerics, {"cells": 8})
    yield Run("C6", chain.disc_column, scheme, 2, numerics)
    yield Run("E9", incline.rolling, scheme, 2, numerics, {"cells": 8})
    for cells in (10, 20):
        yield Run("C1", grains.hertz_wall, scheme, 3, numerics, {"cells": cells}, slow=True)
    yield Run("C2", grains.hertz_chain, scheme, 3, numerics, {"cells": 10}, slow=True)
    yield Run("C5", rolling.rolling_on_discs, scheme, 2, numerics, {"cells": 16}, slow=True)
    yield Run("C6", chain.disc_column, scheme, 2, numerics, {"cells": 10}, slow=True)
    yield Run("E9", incline.rolling, scheme, 2, numerics, {"cells": 16}, slow=True)
    more = {"cells": 6, "speed": 1.0}
    yield Run("E10", groups.offset_spheres, scheme, 3, numerics, more, slow=True)


def _in_body() -> Iterator[Run]:
    """Return cases of bodies on nodes of their own."""
    scheme = choices.AFFINE["scheme"]

    def runs(problem: str, make: Callable[..., list[Figure]], *options: dict) -> Iterator[Run]:
        slow = make in (in_body.simple_shear, in_body_contact.rings, in_body_contact.hertz_chain)
        for given in options or ({},):
            more = dict(given)
            dimension, long = more.pop("dimension", 2), more.pop("slow", slow)
            yield Run(problem, make, scheme, dimension, MATERIAL, more, long)

    solid, contact = {"dimension": 3}, in_body_contact
    for cells in ({"cells": 13}, {"cells": 26}):
        yield from runs("E1", in_body.vibration, cells, solid | cells)
    yield from runs("E11", in_body.under_gravity, {}, solid)
    many = [{"cells": cells} for cells in (50, 100, 200)]
    yield from runs("E2", in_body.two_bars, *many, {"cells": 100, "speed": 0.1}, solid)
    yield from runs("rod", in_body.rod_energy, many[0], many[2])
    yield from runs("E2b", in_body.unequal_bars, {}, {"cells": 100})
    yield from runs("E3", in_body.rigid_translation, {}, solid)
    yield from runs("E3", in_body.free_fall, {}, solid)
    yield from runs("E3", written.spinning_disc, {"cells": 10}, {"cells": 20})
    yield from runs("E4", in_body.simple_shear)
    discs = {"cells": 40}, {"cells": 80}, {"model": "elastic"}
    yield from runs("E5", contact.sulsky_discs, *discs)
    yield from runs("E6", contact.rings, {"cell_mm": 1.25}, {"cell_mm": 0.8})
    yield from runs("E9b", in_body.five_bars, *many[1:])
    yield from runs("E9b", contact.three_discs)
    yield from runs("E9b", contact.many_bodies, {}, solid | {"bodies": 5, "steps": 300})
    yield from runs("E9b", contact.renumbering, {}, solid | {"steps": 100, "slow": True})
    spheres = solid | {"speed": 1.0, "slow": True}
    for cells in ({"cells": 6}, {"cells": 6, "speed": 4.0}, {"cells": 10, "offsets": ("0.5",)}):
        yield from runs("E10", contact.offset_spheres, spheres | cells)
    for cells in (solid | {"cells": 10}, solid | {"cells": 20, "slow": True}):
        yield from runs("C1", contact.hertz_wall, cells)
        yield from runs("C1", written.hertz_spheres, cells)
        yield from runs("C2", contact.hertz_chain, cells)
    yield from runs("E8", contact.sliding_block, {}, {"across": 16})
    yield from runs("E8", contact.sticking_block)
    yield from runs("oblique", contact.oblique_impact, {}, {"slip": 0.05}, {"cells": 32}, solid)
    sphere = solid | {"cells": 5, "slow": True}
    yield from runs("E9", contact.roll_down, {"cells": 8}, {"cells": 16}, sphere)
    yield from runs("E9", written.rolling_disc, {"cells": 8}, {"cells": 16})
    yield from runs("C5", contact.rolling_on_discs, {"cells": 8}, {"cells": 16, "slow": True})
    yield from runs("C6", contact.disc_column, {"cells": 10}, {})
    yield from runs("Taylor", examples.taylor_bar, solid | {"slow": True})


_SECONDS = (
    *(bars.five_bars, rolling.rolling_on_discs, incline.rolling, chain.disc_column),
    *(written.spinning_disc, examples.sod_tube),
)
"""What takes seconds with each of the numerics."""


def _with_others_slow(runs: Iterable[Run]) -> Iterator[Run]:
    """Return the runs, of those that take seconds only what a case gets as quick ones."""
    for run in runs:
        fine = run.options.get("cells", 0) >= (200 if run.dimension == 2 else 26)
        seconds = run.make in _SECONDS or fine
        other = run.basis.partition("~")[0] not in (UPDATED, MATERIAL)
        long = (seconds and other) or (fine and run.make is bars.five_bars)
        yield replace(run, slow=run.slow or long)


_WRITTEN = list(_runs())
# Runs that differ in their factor alone are one with the default's.
_OTHERS = [*_in_space(_WRITTEN), *_with_impulses(), *_in_body()]
_ALL = {run.title: run for run in [*_WRITTEN, *_OTHERS]}
RUNS = list(_with_others_slow(_ALL.values()))
