# SPDX-License-Identifier: BSD-3-Clause
"""Where contact makes or takes energy, though a case asks for it; gases without viscosity."""

from __future__ import annotations

from mpm3dpp import _core
from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case
from mpm3dpp.case.grid import CONTACT


def parts_by_matter(case: Case) -> dict[str, list[str]]:
    """Return the names of bodies and entries of grains that are a "solid", a "liquid", a "gas"."""
    found: dict[str, list[str]] = {"solid": [], "liquid": [], "gas": []}
    for name, part in case.parts().items():
        matter = case.material[part.material].matter() if case.flows(name) else "solid"
        found[matter].append(name)
    return found


def _unviscous(case: Case) -> list[str]:
    """Gases that have no artificial viscosity, without which a shock is noise that grows."""
    gases = [name for name in case.materials_used if case.material[name].matter() == "gas"]
    bare = [name for name in gases if case.viscosity_of(name) == (0.0, 0.0)]
    return [
        f"{key_text(('material', name))} is a gas without artificial viscosity: a shock in it "
        "becomes noise that may grow without limit; leave factors of 0 out"
        for name in bare
    ]


def response_notes(case: Case) -> list[str]:
    """Return a sentence each: springs of gases and between liquids, walls, gases' viscosity."""
    response, word = case.contact.response, case.run.transfer.word
    found = [*_unviscous(case)]
    bodies = parts_by_matter(case)
    if (
        case.contact_enabled
        and response == "springs"
        and (bodies["gas"] or len(bodies["liquid"]) > 1)
    ):
        first, *rest = [*bodies["gas"], *bodies["liquid"]]
        what = f"{key_text(case.part_path(first))}, a gas, meets other bodies"
        if not bodies["gas"]:
            second = key_text(case.part_path(rest[0]))
            what = f"the liquids {key_text(case.part_path(first))} and {second} meet"
        found.append(
            f'contact.response = "springs" makes energy where {what}: leave it out, which gives '
            'such pairs impulses ("by_matter")'
        )
    if CONTACT in case.grid.walls and bodies["gas"]:
        found.append(
            f"faces of the box that are contact take much of the energy of "
            f'{key_text(case.part_path(bodies["gas"][0]))}, a gas: give grid.box.walls = "slip"'
        )
    affine = _core.transfers[word]["affine"]
    if CONTACT in case.grid.walls and response != "impulses" and not affine:
        fits = _core.bases[case.grid.basis]["second_moment"] > 0.0
        others = "run.transfer, which is then" if fits else "grid.basis and run.transfer, then with"
        found.append(
            f'contact.response = "{response}" makes energy at walls that are contact where '
            f'run.transfer is "{word}": leave contact.response out, which stops approach there, or '
            f'{others} "aflip"'
        )
    return found
