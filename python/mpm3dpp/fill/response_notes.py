# SPDX-License-Identifier: BSD-3-Clause
"""Where contact makes or takes energy, though a case asks for it."""

from __future__ import annotations

from mpm3dpp import _core
from mpm3dpp.base.errors import key_text
from mpm3dpp.case.box import CONTACT
from mpm3dpp.case.case import Case
from mpm3dpp.case.matter import liquids_that_meet, parts_by_matter


def response_notes(case: Case) -> list[str]:
    """Return a sentence each: springs of gases and between liquids, and walls that are contact."""
    response, word = case.contact.response, case.run.transfer.word
    found: list[str] = []
    bodies, liquids = parts_by_matter(case), liquids_that_meet(case)
    if case.contact_enabled and response == "springs" and (bodies["gas"] or liquids):
        what = ""
        if bodies["gas"]:
            what = f"{key_text(case.part_path(bodies['gas'][0]))}, a gas, meets other bodies"
        elif len(liquids) == 1:
            what = f"the liquid bodies of {key_text(case.part_path(liquids[0]))} meet each other"
        else:
            first, second = (key_text(case.part_path(name)) for name in liquids[:2])
            what = f"the liquids {first} and {second} meet"
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
