# SPDX-License-Identifier: BSD-3-Clause
"""What is said of a case that settles: of bodies that are held, of steps, and where nothing can."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from commands import mpm3dpp
from mpm3dpp import Case, CaseError, run_case
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build
from mpm3dpp.run.estimate import estimate_line
from mpm3dpp.run.summary import echo
from settling import ONLY_LOAD, hammer


def test_the_summary_begins_at_the_time_0(tmp_path: Path) -> None:
    """Speeds and energies "before" are those with which the run begins, not those of the wait."""
    (tmp_path / "case.toml").write_text(hammer())
    out = mpm3dpp("run", "case.toml", "--out", "out", cwd=tmp_path)
    assert "hammer: 5 -> 5.098 m/s (0, -5.098), kinetic energy 62.5 -> 64.98 J/m" in out.stdout


def test_check_tells_of_it(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    case = Case.from_text(hammer())
    [said] = [note for note in notes(case, build(case)) if "run.settle" in note]
    assert said == (
        "body.hammer has a velocity at the start: it is held while the case settles (run.settle), "
        "and set going with it at t = 0"
    )
    assert re.search(r"up to [\d,]+ steps to settle, then ", echo(case, build(case)))
    assert re.search(r"of which to settle at most (about|less)", estimate_line(case, build(case)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (hammer().replace('"60 mm"] } }', '"60 mm"] } }\nvelocity = [0, 1]'), "leaves no body to"),
        (hammer().replace("[material.rubber]", "[contact]\nbonded = true\n[material.rubber]"),
         "would hold body.hammer"),
        (hammer(more=ONLY_LOAD).replace('gravity = [0, "-9.81 m/s^2"]', ""),
         r"needs a force on the bodies that settle \(block\)"),
        (hammer().replace('gravity = [0, "-9.81 m/s^2"]', ""), "needs a force to settle under"),
    ],
)  # fmt: skip
def test_refuses_what_cannot_settle(text: str, message: str, tmp_path: Path) -> None:
    """One sentence with the key, by check and by run."""
    with pytest.raises(CaseError, match=message) as caught:
        build(Case.from_text(text))
    assert "run.settle" in str(caught.value)
    (tmp_path / "case.toml").write_text(text)
    for word in (["check"], ["run", "--out", "out"]):
        out = mpm3dpp(word[0], "case.toml", *word[1:], cwd=tmp_path)
        assert out.returncode != 0 and "Traceback" not in out.stderr
        assert re.search(message, out.stderr)


def test_a_force_that_vanishes_is_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """A formula may be zero everywhere, which no check of the case sees."""
    text = hammer().replace('gravity = [0, "-9.81 m/s^2"]', "")
    block = 'upper = ["100 mm", "60 mm"] } }'
    assert block in text
    force = block + '\nbody_force = [0, { expression = "0 * x" }]'
    run_case(
        Case.from_text(text.replace(block, force)), tmp_path, threads=1, quiet=False, pictures=False
    )
    said = capfd.readouterr().err
    assert "warning: run.settle had nothing to settle" in said and "nan" not in said
