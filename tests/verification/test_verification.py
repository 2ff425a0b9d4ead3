# SPDX-License-Identifier: BSD-3-Clause
"""Every run of the verification table. What misses its tolerance must stay within misses.json.

misses.json holds, for figures that miss the tolerance of reference.json, the range that we do
reach and why; it is never a reason to change a tolerance.
"""

import json
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

from verification.runs import RUNS

MISSES = json.loads((Path(__file__).parent / "misses.json").read_text())


def reached(title, name):
    """The range [low, high] that a figure known to miss reaches, or None."""
    for miss in MISSES:
        if fnmatchcase(title, miss["run"]) and fnmatchcase(name, miss["figure"]):
            assert miss["why"]
            return miss["reached"]
    return None


@pytest.mark.parametrize(
    "run",
    [pytest.param(run, id=run.title, marks=[pytest.mark.slow] if run.slow else []) for run in RUNS],
)
def test_run(run):
    figures, stopped, _ = run.figures()
    # A run may only stop if it is known to: then that alone is its figure.
    assert not stopped or reached(run.title, "stopped") is not None, stopped
    assert figures or stopped
    wrong = []
    for figure in figures:
        if figure.passed:
            continue
        known = reached(run.title, figure.name)
        if known is None or not known[0] <= figure.ours <= known[1]:
            wrong.append(f"{figure.name}: {figure.ours:.6g}, answer {figure.answer}, "
                         f"tolerance {figure.tolerance}, known range {known}")  # fmt: skip
    assert not wrong, "\n".join(wrong)
