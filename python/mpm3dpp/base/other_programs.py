# SPDX-License-Identifier: BSD-3-Clause
"""Files of other programs that are not read: they are known by how they begin, and told by name."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .errors import CaseError, show

_HEAD = 1 << 13  # Bytes that are looked at.
_STL_HEAD, _STL_FACET = 84, 50  # Bytes of a binary STL file.

_CASE = (
    "write a case file (`mpm3dpp examples` has some to begin with); bodies that no shape makes "
    'may be points in a CSV file, particles = "points.csv"'
)
_SURFACE = (
    "no body is made of a surface of triangles: give a shape, or the points inside it as a CSV "
    'file, particles = "points.csv"'
)


@dataclass(frozen=True)
class _Program:
    """How the files of a program begin.

    Attributes:
        what: they are, for messages.
        begins: what the first line is that is neither blank nor a comment, from its begin on.
        comments: how comments begin.
        has: what stands further down too, anywhere near the begin.
        remedy: what to do with one.
    """

    what: str
    begins: str
    comments: tuple[str, ...] = ()
    has: str = ""
    remedy: str = _CASE


_KARAMELO = "method|dimension|region|solid|eos|strength|material|temperature|damage|group|fix"
_PROGRAMS = (
    _Program("an STL surface", r"solid\b", has=r"^\s*facet\s+normal", remedy=_SURFACE),
    _Program("a PLY surface", r"ply$", has=r"^format ", remedy=_SURFACE),
    _Program("a VTK file", r"# vtk datafile|<VTKFile"),
    _Program("a mesh of Gmsh", r"\$MeshFormat"),
    _Program("an input file of LS-DYNA", r"\*KEYWORD\b", ("$",)),
    _Program("an input file of LS-DYNA", r"\*[A-Z_]+\b", ("$",), r"^\$"),
    _Program(
        "an input file of Abaqus",
        r"\*(heading|preprint|part|node|assembly|include|parameter|system)\b",
        ("**",),
    ),
    _Program("an input file of Radioss", r"#RADIOSS\b|/BEGIN\b", has=r"^/BEGIN\b"),
    _Program("an input file of NairnMPM", r"<\?xml|<!DOCTYPE|<JANFEAInput", has="<JANFEAInput"),
    _Program(
        "an input file of NairnMPM",
        r"(title|name|header|analysis|#?include|define)\b",
        (";", "//"),
        r"^\s*(analysis|mpmmethod)\b\s*[\"\w]",
    ),
    _Program("an input file of Karamelo", r"\w+\s*[=(]", ("#",), rf"^\s*({_KARAMELO})\s*\("),
    _Program(
        "an input file of CB-Geo MPM",
        r"\{",
        has=r"\"(mesh|materials|particles|analysis|material_sets)\"\s*:",
    ),
)


def mistaken_file(data: bytes, size: int | None = None) -> CaseError | None:
    """Return the mistake that a file is one of another program; None if it is none that is known.

    Args:
        data: the file, or its begin.
        size: of the whole file [bytes]; by default `data` is all of it.
    """
    size = len(data) if size is None else size
    if _is_binary_stl(data, size):
        return CaseError("is an STL surface, in binary form", _SURFACE)
    head = data[:_HEAD].decode("utf-8-sig", errors="replace")
    lines = [line.strip() for line in head.splitlines()]
    for program in _PROGRAMS:
        first = next((n for n in lines if n and not n.startswith(program.comments or ("\0",))), "")
        if not re.match(program.begins, first, re.I):
            continue
        if re.search(program.has, head, re.I | re.M):
            rule = f"is {program.what}, as its line {show(first[:40])} tells"
            return CaseError(rule, program.remedy)
    return None


def _is_binary_stl(data: bytes, size: int) -> bool:
    if len(data) < _STL_HEAD or size <= _STL_HEAD:
        return False
    facets = int.from_bytes(data[_STL_HEAD - 4 : _STL_HEAD], "little")
    return size == _STL_HEAD + _STL_FACET * facets
