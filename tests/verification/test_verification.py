# SPDX-License-Identifier: BSD-3-Clause
"""Every run of the verification table. What misses its tolerance must miss it as misses.json says.

misses.json holds, for figures that miss the tolerance of reference.json, the range that we do
reach and why; it is never a reason to change a tolerance. What no longer misses must go from it: a
range for what passes would let it grow worse unseen. `decided_by` marks the few that may do either,
because they lie at their limit and "rounding" (of the processor) or an "offset" (of the grid within
a cell) decides.
"""

import json
from pathlib import Path

import pytest

from verification.figure import Figure
from verification.runs import RUNS

MISSES = {
    (miss["run"], miss["figure"]): miss
    for miss in json.loads((Path(__file__).parent / "misses.json").read_text())
}


def wrong(title: str, figures: list[Figure], stopped: str, misses: dict) -> list[str]:
    """Return what does not agree with the tolerances and the known misses of a run, in words."""
    known = {figure: miss for (run, figure), miss in misses.items() if run == title}
    stops, said = known.pop("stopped", None), []
    if stopped and stops is None:
        said.append(stopped)
    if stops is not None and not stopped and "decided_by" not in stops:
        said.append("no longer stops: take it out of misses.json")
    missed = {figure.name for figure in figures if not figure.passed}
    for figure in figures:
        if figure.passed and figure.name in missed:
            continue  # Of two figures of one name the other is held to the known miss.
        miss = known.get(figure.name)
        text = f"{figure.name}: {figure.ours:.6g}, answer {figure.answer}"
        if miss is None:
            if not figure.passed:
                said.append(f"{text}, tolerance {figure.tolerance}")
        elif figure.passed:
            if "decided_by" not in miss:
                said.append(f"{text}: no longer misses, take it out of misses.json")
        elif not miss["reached"][0] <= figure.ours <= miss["reached"][1]:
            said.append(f"{text}, known range {miss['reached']}")
    if not stopped:
        gone = known.keys() - {figure.name for figure in figures}
        said += [f"{figure}: no such figure, but a miss of it" for figure in sorted(gone)]
    return said


BY_DEFAULT = {(run.problem, run.make) for run in RUNS if run.basis.startswith("updated")}


def is_slow(run):
    """What users get by default, in both frames, is run in each test run; others of it are slow."""
    other = not run.basis.startswith(("updated", "material"))
    other = other and (run.problem, run.make) in BY_DEFAULT
    return run.slow or other


@pytest.mark.parametrize(
    "run",
    [
        pytest.param(run, id=run.title, marks=[pytest.mark.slow] if is_slow(run) else [])
        for run in RUNS
    ],
)
def test_run(run):
    figures, stopped, _ = run.figures()
    assert figures or stopped
    said = wrong(run.title, figures, stopped, MISSES)
    assert not said, "\n".join(said)


def test_known_misses_are_of_runs_and_have_a_reason():
    titles = {run.title for run in RUNS}
    for (run, _), miss in MISSES.items():
        assert run in titles
        assert miss["why"]
        assert miss.get("decided_by") in (None, "rounding", "offset")


def figure(ours: float) -> Figure:
    return Figure("speed", "m/s", ours, 10.0, 0.1, "D")


@pytest.mark.parametrize(
    ("ours", "marked", "right"),
    [(11.0, {}, True), (10.05, {}, False), (12.0, {}, False),
     (10.05, {"decided_by": "rounding"}, True), (12.0, {"decided_by": "rounding"}, False)],
)  # fmt: skip
def test_a_miss_that_no_longer_misses_fails(ours, marked, right):
    misses = {("E1 bar", "speed"): {"reached": [9.9, 11.5], "why": "coarse", **marked}}
    assert (not wrong("E1 bar", [figure(ours)], "", misses)) is right
    assert wrong("E2 bar", [figure(11.0)], "", misses)  # another run
    assert wrong("E1 bar", [], "", misses)  # no such figure
    stops = {("E1 bar", "stopped"): {"reached": [0, 0], "why": "unstable", **marked}}
    assert not wrong("E1 bar", [], "unstable at step 3", stops)
    assert wrong("E1 bar", [], "unstable at step 3", misses)
    assert (not wrong("E1 bar", [figure(10.0)], "", stops)) is bool(marked)
