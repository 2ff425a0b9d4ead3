# SPDX-License-Identifier: BSD-3-Clause
"""Where springs of contact make energy, though a case asks for them."""

from __future__ import annotations

from mpm3dpp import _core
from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case
from mpm3dpp.case.grid import CONTACT


def response_notes(case: Case) -> list[str]:
    """Return a sentence each: springs of what flows, and of walls without an affine transfer."""
    found = []
    response, word = case.contact.response, case.run.transfer.word
    flowing = [name for name in case.parts() if case.flows(name)]
    if case.has_springs and response == "springs" and flowing:
        flows = key_text(case.part_path(flowing[0]))
        found.append(
            f'contact.response = "springs" makes energy where {flows}, which flows, meets other '
            'bodies: leave it out, which gives such pairs impulses ("by_matter")'
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
