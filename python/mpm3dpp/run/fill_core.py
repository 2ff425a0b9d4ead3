# SPDX-License-Identifier: BSD-3-Clause
"""The core of a simulation: made with a case's settings, filled with its materials and bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mpm3dpp import _core
from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.case.case import Case
from mpm3dpp.case.frame import in_body
from mpm3dpp.case.pairs import listed_pairs
from mpm3dpp.fill.initial import overburden
from mpm3dpp.fill.interference import Interference
from mpm3dpp.fill.parts import Filled
from mpm3dpp.fill.surface_notes import bond_of_nothing
from mpm3dpp.fill.surface_points import point_spacing
from mpm3dpp.ranks.world import World

from .add_part import add_part, kind_of
from .core_settings import core_settings


def new_core(
    case: Case,
    threads: int,
    fused: bool,
    disorder: float | None,
    imbalance_limit: float | None,
    ranks: int,
    world: World | None,
) -> Any:
    """Return a core without bodies; the arguments are those of `Simulation`."""
    settings = core_settings(case, threads)
    settings.execution.fused = fused
    settings.execution.ranks = arguments.whole_number("ranks", ranks, 1, 1024)
    for name, value in (("disorder", disorder), ("imbalance_limit", imbalance_limit)):
        if value is not None:
            setattr(settings.execution, name, value)
    return _core.Simulation(settings, world.for_core() if world else None)


def fill_core(core: Any, case: Case, filled: Filled, world: World | None) -> dict[str, float]:
    """Give the core the materials that are used and the bodies, which are taken out of `filled`.

    Args:
        core: without bodies.
        case: of the simulation.
        filled: its bodies; afterwards `filled.parts` is empty, so that memory holds them once.
        world: processes that each give a share.

    Returns:
        The mass of each body, and of all the grains of an entry [kg; in 2D per metre].
    """
    used = dict.fromkeys(kind_of(case, part) for part in filled.parts.values())
    numbers = {kind: _add_material(core, case, *kind) for kind in used}
    above = overburden(case, filled, world)
    masses = {name: float(part.masses.sum()) for name, part in filled.parts.items()}
    spacing = point_spacing(case, filled.parts.values())
    for name in list(filled.parts):
        add_part(core, case, filled.parts.pop(name), numbers, above, spacing, world)
    return masses


def _add_material(core: Any, case: Case, name: str, frame: str) -> int:
    """Return the number that the core gives to a material, of bodies of one frame."""
    material, viscosity = case.material[name], case.viscosity_of(name)
    number = core.add_material(
        **material.for_core(),
        viscosity=viscosity,
        damping=material.beta,
        in_body=frame == MATERIAL,
    )
    return int(number)


def prepare_core(
    core: Any, case: Case, bodies: Sequence[str], drawn: Sequence[Interference]
) -> None:
    """Make a filled core ready to step.

    Args:
        core: with all that acts on its bodies.
        case: of the simulation.
        bodies: their names, in the order of their numbers.
        drawn: which of them are drawn into each other.

    Raises:
        CaseError: the core refuses the bodies, or the step, now that all are there.
    """
    for one in drawn:
        if one.pressed:
            core.press(bodies.index(one.first), bodies.index(one.second), one.depth)
    try:
        core.prepare()
    except ValueError as error:
        raise _refusal(case, str(error)) from None
    _check_bonds(case, set(core.bonded_groups()))


def _check_bonds(case: Case, held: set[tuple[int, int]]) -> None:
    """Refuse bonds of bodies on nodes of their own that touch nowhere.

    Args:
        case: of the simulation.
        held: the numbers of the bodies, or first grains, between which some bond holds.
    """
    if not in_body(case):
        return
    bonds = listed_pairs(case)
    for k, pair in enumerate(case.contact.pair):
        ends = [numbers for numbers, listed in bonds.items() if listed is pair]
        if not pair.bonded or not ends or held & set(ends):
            continue
        raise bond_of_nothing(case, k)


def _refusal(case: Case, sentence: str) -> CaseError:
    """Return the mistake for what the core says of bodies that are all there."""
    if sentence.startswith("frame = "):
        rule, _, remedy = sentence.partition(": ")
        return CaseError(rule, remedy)
    key, step = "run.time_step", case.run.time_step
    if not sentence.startswith(key):
        return CaseError(sentence, "bring the bodies together, or give larger cells")
    rule = sentence.partition(" s ")[2]
    remedy = "give a smaller one, or leave it out"
    return case.error(("run", "time_step"), rule, remedy, value=step)
