# SPDX-License-Identifier: BSD-3-Clause
"""Damaged input files of MPM3D-F90: a case or a sentence, soon, never a traceback."""

from __future__ import annotations

import gzip
import random
import re
import warnings
from pathlib import Path

import pytest

from mpm3dpp import CaseError
from mpm3dpp.importers.mpm3d.lexer import split
from mpm3dpp.importers.mpm3d.to_case import import_source
from mpm3dpp.importers.write import case_text
from mpm_text import GOOD, TWO

REAL = Path(__file__).parents[1] / "verification" / "mpm"
LOADS = GOOD.replace(
    "endi\n", "load part 3 0 0 0 grav 1 0 0 -1 body 1 1 0 0 endl\nsmooth\ngimp\ntecp\nendi\n"
)
BODIES = GOOD.replace("nbbo 1", "nbbo 2").replace("nbco 1", "nbco 2").replace("nbmp 64", "nbmp 99")
CONT = "cont lagr 0.3 0\nendi\n"
CUT = 60  # Records of single particles that are kept of a file: enough, and quick.
WORDS = ["-0", "nan", "inf", "-inf", "1e400", "-1e99", "1e-320", "1d3", "1.5.2", "1e", "+", "-",
         "0", "-1", "1", "2", "3", "999999999", "1000000000", "1e50", "0.5", "endi", "part",
         "block", "sphere", "blod", "cicl", "point", "load", "velo", "endl", "endv", "mate", "seos",
         "cont", "lagr", "others", "gimp", "grav", "body", "node", "usf on", "QuLo", "Damp",
         "elas", "neoh", "null", "hiex", "\x00", "é", "!", ",", "\n", "\t", '"', "=",
         "x" * 300]  # fmt: skip


def texts() -> dict[str, str]:
    """The real files, those with thousands of points cut down, and the tests' own."""
    found = {"good": GOOD, "loads": LOADS, "two": BODIES.replace("endi\n", TWO[1].format(2) + CONT)}
    for path in sorted(REAL.glob("*.mpm*")):
        data = path.read_bytes()
        text = (gzip.decompress(data) if path.suffix == ".gz" else data).decode("latin-1")
        lines = re.split(r"(?<=\n)", text)
        points = [k for k, line in enumerate(lines) if re.match(r"\s+\d+\s+1\s+\d\.\d+[Ee]", line)]
        gone = set(points[CUT:])
        text = "".join(line for k, line in enumerate(lines) if k not in gone)
        found[path.name] = re.sub(r"(point 1) \d+", rf"\1 {min(len(points), CUT)}", text)
    return found


def damaged(text: str, chance: random.Random) -> str:
    """A text with one to four of its words changed, or characters or lines lost or doubled."""
    for _ in range(chance.choice((1, 1, 2, 4))):
        kind = chance.randrange(6)
        words = [*re.finditer(r"\S+", text)] or [re.match("", text)]
        at = chance.choice(words)
        assert at is not None
        if kind <= 2:
            text = text[: at.start()] + chance.choice(WORDS) + text[at.end() :]
        elif kind == 3:
            text = text[: at.start()] + text[at.end() :]
        elif kind == 4:
            lines = text.splitlines(keepends=True)
            k = chance.randrange(len(lines)) if lines else 0
            lines[k : k + 1] = chance.choice(([], lines[k : k + 1] * 2))
            text = "".join(lines)
        else:
            k = chance.randrange(len(text) + 1)
            text = text[:k] + chance.choice(("", "\x00", "9", "-", ".", "\n")) + text[k + 1 :]
    return text


@pytest.mark.parametrize("name", texts())
def test_damaged_files(name: str) -> None:
    text, chance = texts()[name], random.Random(f"mpm {name}")
    outcomes = set()
    for _ in range(120):
        trial = damaged(text, chance)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                found = import_source(split(trial), "mm-g-N-ms")
                tables = dict(found.tables)
                tables["body"] = {
                    key: {k: v for k, v in body.items() if k != "particles"}
                    for key, body in tables["body"].items()
                }
                case_text(found, tables)
            outcomes.add("case")
        except CaseError as error:
            assert all(re.match(r"case\.mpm", line) for line in str(error).splitlines()), trial
            outcomes.add("sentence")
        except Exception as error:
            raise AssertionError(f"{error!r} of\n{trial}") from error
    assert outcomes == {"case", "sentence"}
