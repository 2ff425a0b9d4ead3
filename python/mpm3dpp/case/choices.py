# SPDX-License-Identifier: BSD-3-Clause
"""Basis, transfer, scheme and step of a case that does not say them: they are chosen together.

By what was measured on thirteen problems (docs/decisions/0048-the-table.md): a basis with which an
affine transfer goes has AFLIP, and this has USF and steps twice as long as those of the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mpm3dpp import _core
from mpm3dpp.base.model import plain

from .transfer import Transfer

if TYPE_CHECKING:
    from .parts import Run

BASIS, TRANSFER = "quadratic_bspline", "aflip"
AFFINE: dict[str, Any] = {"scheme": "usf", "cfl": 0.5}
OTHERS: dict[str, Any] = {"scheme": "musl", "cfl": 0.25}
OTHER_TRANSFER = "flip"


def with_choices(run: Run, basis: str) -> Run:
    """Return a run with what it leaves out of `transfer`, `scheme` and `cfl`.

    Args:
        run: of a case; it stays as it is, as another case may have it too, and is returned if it
            has all of that.
        basis: a word of `grid.basis`.
    """
    given, chosen = run.model_fields_set, {}
    if "transfer" not in given:
        affine = _core.bases[basis]["second_moment"] > 0.0
        chosen["transfer"] = Transfer.model_validate(TRANSFER if affine else OTHER_TRANSFER)
    word = chosen.get("transfer", run.transfer).word
    more = AFFINE if _core.transfers[word]["affine"] else OTHERS
    chosen |= {key: value for key, value in more.items() if key not in given}
    if all(plain(getattr(run, key)) == plain(value) for key, value in chosen.items()):
        return run
    run = run.model_copy()
    run.__dict__.update(chosen)
    return run
