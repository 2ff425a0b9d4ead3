# SPDX-License-Identifier: BSD-3-Clause
"""The examples of the paper: their case files, and what is changed in them for a quick look."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mpm3dpp.base.errors import CaseError, key_text, nearest
from mpm3dpp.case import file as case_file
from mpm3dpp.case.case import Case
from mpm3dpp.case.changes import Changes, with_changes

from . import paper

SIZES = ("quick", "paper")


@dataclass(frozen=True)
class Example:
    """An example of the paper.

    Attributes:
        name: what the user types.
        section, title: of the paper.
        files: the case file of each run, by what the run is called.
        figures: numbers of the paper's figures that its pictures stand for.
        frames: number of frames that a run writes after the first.
        quick: gives the changes for a quick look from the case as it is.
        table: the paper's table, if its time and memory are measured.
        timed_from: share of the end time after which steps are timed.
        projectile: the body whose residual speed counts.
        particles: what the paper says of them, where it has no table.
    """

    name: str
    section: str
    title: str
    files: dict[str, str]
    figures: tuple[int, ...]
    frames: int
    quick: Callable[[Case], Changes]
    table: paper.Table | None = None
    timed_from: float = 0.0
    projectile: str = ""
    particles: int | None = None


def _coarser(factor: float) -> Callable[[Case], Changes]:
    return lambda case: {("grid", "cell_size"): factor * case.grid.cell_size}


def _shorter(share: float) -> Callable[[Case], Changes]:
    return lambda case: {("run", "end_time"): share * case.run.end_time}


def fewer_spheres(edge: int) -> Callable[[Case], Changes]:
    """Return the changes that leave `edge`^3 spheres, with box and slab cut to fit."""

    def changes(case: Case) -> Changes:
        lattice = case.grains["spheres"].lattice
        assert lattice is not None
        box, shape = case.grid.box, case.body["slab"].shape
        assert box is not None
        slab: Any = shape
        whole = [2 * lattice.radius * n for n in lattice.count]
        cut = [2 * lattice.radius * edge] * 3
        thick = [float(x) for x in (0.0, 0.0, slab.upper[2] - slab.lower[2])]
        roof = [a + b for a, b in zip(cut, thick, strict=True)]
        share = max(cut) / max(whole)
        return {
            ("grains", "spheres", "lattice", "count"): [edge] * 3,
            ("grid", "box", "upper"): roof,
            ("body", "slab", "shape"): {"box": {"lower": [0.0, 0.0, cut[2]], "upper": roof}},
            ("run", "end_time"): share * case.run.end_time,  # Waves have less far to go.
        }

    return changes


EXAMPLES = {
    example.name: example
    for example in (
        Example(
            "penetration",
            "4.1",
            "Penetration",
            {"": "02_penetration/case_paper.toml"},
            figures=(9, 10),
            frames=14,
            quick=_coarser(2.0),
            table=paper.PENETRATION,
            timed_from=0.25,  # The projectile is in the plate.
            projectile="rod",
        ),
        Example(
            "spheres",
            "4.2",
            "Spheres under pressure",
            {"": "03_thousand_spheres/case_paper.toml"},
            figures=(12,),
            frames=8,
            quick=fewer_spheres(4),
            table=paper.SPHERES,
        ),
        Example(
            "grains",
            "4.3",
            "Shakes of grains",
            {"": "04_shaking_grains/case_paper.toml"},
            figures=(13,),
            frames=12,
            quick=_shorter(0.05),
        ),
        Example(
            "rings",
            "4.4",
            "Collision of two elastic rings",
            {
                "velocity": "01_two_rings/case_paper_velocity.toml",
                "gap": "01_two_rings/case_paper.toml",
            },
            figures=(14, 15),
            frames=14,
            quick=_coarser(2.5),
            particles=paper.RING_PARTICLES,
        ),
    )
}


def chosen(only: Iterable[str], folder: Path) -> tuple[list[Example], list[Example]]:
    """Return the examples to run, in the paper's order, and those whose files are missing.

    Args:
        only: their names; none for all that are there.
        folder: with the example cases.

    Raises:
        CaseError: there is no such example; its case file is missing though it is asked for; or
            no file is there at all.
    """
    names = list(only)
    for name in names:
        if name not in EXAMPLES:
            rule = "is not an example of the paper"
            raise CaseError(rule, nearest(name, EXAMPLES), key="--only", value=name)
    there: list[Example] = []
    missing: list[Example] = []
    for example in EXAMPLES.values():
        if names and example.name not in names:
            continue
        absent = [file for file in example.files.values() if not (folder / file).is_file()]
        if absent and names:
            rule = f"is the case of --only {example.name} but is missing"
            remedy = "give another --only, or with --examples the folder that holds it"
            raise CaseError(rule, remedy, key=str(folder / absent[0]))
        (missing if absent else there).append(example)
    if not there:
        rule = "has none of the examples of the paper"
        remedy = "give with --examples the folder that holds 01_two_rings and others"
        raise CaseError(rule, remedy, key=str(folder))
    return there, missing


def load(example: Example, label: str, folder: Path, size: str) -> tuple[Case, Changes]:
    """Return a case of an example in a size, and what was changed in its file, in SI units.

    Args:
        example: of `EXAMPLES`.
        label: of the run, a key of `example.files`.
        folder: with the example cases.
        size: "quick" or "paper".

    Raises:
        CaseError: the case has a mistake, or lacks what the size changes.
    """
    path = folder / example.files[label]
    whole = Case.from_text(case_file.read_text(path), str(path))
    changes: dict[tuple[str, ...], Any] = {
        ("output", "frames"): example.frames,
        ("output", "interval"): None,
    }
    if size == "quick":
        try:
            changes |= example.quick(whole)
        except (AttributeError, AssertionError, KeyError, TypeError):
            rule = f"is not laid out as the example {example.name}, so that it has no quick size"
            raise CaseError(rule, "give --size paper", place=str(path)) from None
    return with_changes(whole, changes), changes


def change_lines(changes: Changes) -> list[str]:
    """Return what was changed, a line for each key that has a value."""
    given = {key_text(path): value for path, value in changes.items() if value is not None}
    return [f"{key} = {_value(value)}" for key, value in given.items()]


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        return f"[{', '.join(_value(item) for item in value)}]"
    if isinstance(value, dict):
        inner = ", ".join(f"{key} = {_value(item)}" for key, item in value.items())
        return f"{{ {inner} }}"
    return str(value)
