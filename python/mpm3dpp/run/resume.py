# SPDX-License-Identifier: BSD-3-Clause
"""Which checkpoint of a folder a run goes on from, and which run may begin anew there."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from mpm3dpp.base.errors import CaseError, show
from mpm3dpp.case.case import Case
from mpm3dpp.case.choose_frames import in_frames
from mpm3dpp.io.checkpoint import ANEW, CHECKPOINT, PREVIOUS, DamagedError, restore_checkpoint
from mpm3dpp.io.stored_manifest import manifest_data
from mpm3dpp.io.vtkhdf import RESULTS

from .checkpoints import Checkpoint

if TYPE_CHECKING:
    from .simulation import Simulation

T = TypeVar("T")


def go_on(
    folder: Path, case: Case, make: Callable[[], Simulation]
) -> tuple[Simulation, Checkpoint, list[str]]:
    """Return a simulation with the state of the last checkpoint in a folder that can be used.

    Args:
        folder: of the run.
        case: that would go on.
        make: gives a new simulation of it.

    Returns:
        The simulation, the checkpoint, and what the user should know of it.

    Raises:
        CaseError: there is none, or it is that of another case; nothing has been changed.
    """

    def restored(path: Path) -> tuple[Simulation, Checkpoint]:
        before = Checkpoint.of(path)
        before.check(case)
        simulation = make()
        restore_checkpoint(path, simulation.core)
        simulation.take_device()
        if (simulation.core.step, simulation.core.time) != (before.step, before.time):
            raise DamagedError(f"the checkpoint '{path}' is damaged: its parts differ", ANEW)
        return simulation, before

    (simulation, before), why = _first_that_can(folder, restored)
    notes = [f"{why}: the run goes on from the one before"] if why else []
    for gone, name in (
        (before.results_are_gone and before.results["frames"], RESULTS),
        (before.history_is_gone, "history.csv"),
    ):
        if gone:
            notes.append(f"'{folder / name}' was gone: a new one begins at t = {before.time:.6g} s")
    return simulation, before, notes + before.notes(case)


def as_it_was(folder: Path, case: Case) -> Case:
    """Return a case with the frames that its run had, of bodies that leave them to us.

    They follow from who makes the steps, too, and a run may go on by another.
    """
    for name in (CHECKPOINT, PREVIOUS):
        with suppress(CaseError):
            before = Checkpoint.of(folder / name).case
            parts = {**before.get("body", {}), **before.get("grains", {})}
            had = {one: part["frame"] for one, part in parts.items() if "frame" in part}
            differ = {one: had.get(one, part.frame) for one, part in case.parts().items()}
            same = all(case.parts()[one].frame == frame for one, frame in differ.items())
            return case if same else in_frames(case, differ)
    return case


def _first_that_can(folder: Path, use: Callable[[Path], T]) -> tuple[T, str]:
    """Return what `use` makes of the last checkpoint, else of the one before it; and why, if so.

    Raises:
        CaseError: neither can be used; it is told of the last.
    """
    last, previous = folder / CHECKPOINT, folder / PREVIOUS
    try:
        return use(last), ""
    except DamagedError as error:
        if not previous.is_file():
            raise
        first = error
    try:
        return use(previous), first.rule
    except DamagedError:
        raise first from None


def has_checkpoint(folder: Path) -> bool:
    """Return whether there is a checkpoint in an output folder, or the one before it."""
    return any((folder / name).is_file() for name in (CHECKPOINT, PREVIOUS))


def refuse_to_begin_anew(folder: Path, case: Case) -> None:
    """Raise `CaseError` if a folder holds an unfinished run, or the run of another case.

    It is the same case if its file is, edited or not, or if its content is, wherever the file.
    """
    refuse_another_case(folder, case)
    if not has_checkpoint(folder):
        return
    before = _first_that_can(folder, Checkpoint.of)[0]
    done = max(before.time, 0.0) / before.case["run"]["end_time"]
    if done < 1.0:
        rule = f"'{folder}' holds an unfinished run, at {done:.0%} of its time"
        try:
            _first_that_can(folder, lambda path: Checkpoint.of(path).check(case))
            remedy = f"go on with --resume, {ANEW}, or choose another --out"
        except CaseError as error:
            remedy = f"--resume cannot go on with it ({error.sentence()})"
        raise CaseError(rule, remedy)


def refuse_another_case(folder: Path, case: Case) -> None:
    """Raise `CaseError` if a folder holds the run of another case; see `refuse_to_begin_anew`."""
    try:
        before = manifest_data(folder)
    except CaseError:  # None, or not ours.
        return
    if "case_file" not in before:  # By an earlier version: the file may be the same one, edited.
        return
    file = before["case_file"]
    if before.get("case_hash") in (None, case.case_hash) or (file and file == case.file_path):
        return
    told = before.get("case")
    title = told.get("title") if isinstance(told, dict) else None
    words = show(title) if title and isinstance(title, str) else "", file
    name = " of ".join(word for word in words if word and isinstance(word, str))
    rule = f"'{folder}' holds the run of another case{', ' if name else ''}{name}"
    raise CaseError(rule, f"choose another --out, or {ANEW}")
