# SPDX-License-Identifier: BSD-3-Clause
"""A small input file of MPM3D-F90, and edits of it."""

from __future__ import annotations

from mpm3dpp.importers.imported import Imported
from mpm3dpp.importers.mpm3d.lexer import split
from mpm3dpp.importers.mpm3d.to_case import import_source

GOOD = """\
mpm3d *** a test
! Unit: mm g N ms MPa
nbco 1
nbbo 1
nbmp 64
nmat 1
spx -2 2
spy -2 2
spz 0 4
dcell 1.0
dtscale 0.5
endtime 1.0d-3
outtime 2.0d-4
musl on
jaum on
bulk 1.5 0.06
fixed 0 0 0 0 2 1
material
 1 elas 7.8d-3 210.0d3 0.3
particle block 1
 1 7.8d-3 0.5 0 0 0 4 4 4
velo
 body 1 0.0 0.0 -100.0
endv
endi
"""
PART = "particle block 1\n 1 7.8d-3 0.5 0 0 0 4 4 4\n"
MATE = " 1 elas 7.8d-3 210.0d3 0.3\n"
SEOS = "seos 1 2 3940 1.49 1.96 0\n"


def of(text: str, units: str | None = None) -> Imported:
    return import_source(split(text), units)


def edited(*pairs: tuple[str, str]) -> str:
    text = GOOD
    for old, new in pairs:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def with_part(*statements: str, more: tuple[tuple[str, str], ...] = ()) -> Imported:
    text = edited((PART, "".join(statements)), *more)
    return of(text.replace("nbmp 64", "nbmp 100000").replace("nbbo 1", f"nbbo {len(statements)}"))


TWO = (
    "particle block 1\n 1 7.8d-3 0.5 0 0 0 2 2 2\n",
    "particle block {}\n 1 7.8d-3 0.5 1 0 0 2 2 2\n",
)
