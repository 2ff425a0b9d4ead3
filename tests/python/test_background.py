# SPDX-License-Identifier: BSD-3-Clause
"""Frames are written beside the run: from copies, in order, and a failure is told."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from fake_core import FakeSimulation
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import BackgroundWriter, ResultsWriter, open_results

LONG = 20.0  # [s] Until a test that hangs is given up.


class SlowWriter(ResultsWriter):
    """Waits for permission before it writes a frame; or cannot write at all."""

    def __init__(self, folder: Path, broken: Exception | None = None) -> None:
        super().__init__(
            folder / "results.vtkhdf",
            bodies=["left", "right"],
            materials=["steel", "rubber"],
            dimension=2,
            cell_size=1e-3,
        )
        self.allowed = threading.Semaphore(0)
        self.broken = broken

    def add(self, frame) -> None:
        assert self.allowed.acquire(timeout=LONG)
        if self.broken is not None:
            raise self.broken
        super().add(frame)


def test_frames_are_those_of_their_time(tmp_path: Path) -> None:
    """The simulation goes on while its frames wait."""
    simulation, file = FakeSimulation(), SlowWriter(tmp_path)
    expected = []
    with BackgroundWriter(file) as results:
        for _ in range(2):
            expected.append(np.concatenate([simulation.column(b, "stress") for b in range(2)]))
            results.write(simulation)
            simulation.advance(4)
        assert file.frames == 0
        file.allowed.release(2)
    found = open_results(tmp_path)
    assert found.steps.tolist() == [0, 4]
    for k, stress in enumerate(expected):
        np.testing.assert_array_equal(found.arrays(k)["stress"], stress.astype(np.float32))


FRAME = 14 * 4 * 128  # bytes of 128 particles; the first has body, material and size too


def test_a_step_waits_for_room(tmp_path: Path) -> None:
    """Two frames have room; the third waits for it, and is that of its time all the same."""
    simulation, file = FakeSimulation(), SlowWriter(tmp_path)
    with BackgroundWriter(file, room=2.5 * FRAME) as results:
        results.write(simulation)
        results.write(simulation)
        third = threading.Thread(target=results.write, args=(simulation,))
        third.start()
        third.join(timeout=0.2)
        assert third.is_alive()
        file.allowed.release(2)
        third.join(timeout=LONG)
        assert not third.is_alive()
        file.allowed.release()
    assert len(open_results(tmp_path)) == 3


def test_a_frame_larger_than_the_room_goes_through_column_by_column(tmp_path: Path) -> None:
    """What waits is never more than the room, or one column where that is more."""
    simulation, file = FakeSimulation(), SlowWriter(tmp_path)
    largest, room = 6 * 4 * 128, 4 * 4 * 128
    waiting: list[int] = []
    file.allowed.release(3)
    with BackgroundWriter(file, room=room) as results:
        own = file._own

        def watched(*arguments):
            for found in own(*arguments):
                waiting.append(results._parts._waiting)
                yield found

        file._own = watched
        for _ in range(3):
            results.write(simulation)
            simulation.advance(4)
    assert max(waiting) == largest
    found = open_results(tmp_path)
    assert found.steps.tolist() == [0, 4, 8]
    assert found.arrays(2)["position"][0, 0] > found.arrays(0)["position"][0, 0]


ERRORS = [CaseError("the disk is full"), MemoryError("no room")]


@pytest.mark.parametrize("error", ERRORS)
def test_a_failure_is_told(tmp_path: Path, error: Exception) -> None:
    simulation, file = FakeSimulation(), SlowWriter(tmp_path, error)
    results = BackgroundWriter(file, room=FRAME)
    file.allowed.release(9)
    results.write(simulation)
    with pytest.raises(type(error), match=str(error)):
        for _ in range(5):
            results.write(simulation)
    for _ in range(5):  # Each later frame is refused, and nobody waits.
        with pytest.raises(type(error), match=str(error)):
            results.write(simulation)
    results.check()  # What has been told is not told again.
    results.close()


def test_a_frame_that_cannot_be_copied_takes_no_room(tmp_path: Path) -> None:
    file = SlowWriter(tmp_path)
    with BackgroundWriter(file) as results:
        for _ in range(5):
            with pytest.raises(AttributeError):
                results.write(object())
        results.write(FakeSimulation())
        file.allowed.release()
    assert len(open_results(tmp_path)) == 1


class Breaking(FakeSimulation):
    """Has no memory left for a column in the middle of its second frame."""

    def rounded_derived(self, name: str, writers: Sequence[int] = (0,)) -> np.ndarray:
        if self.step:
            raise MemoryError("no room")
        return super().rounded_derived(name, writers)


def test_nothing_is_written_after_the_end(tmp_path: Path) -> None:
    results = BackgroundWriter(SlowWriter(tmp_path), room=FRAME)
    results.close()
    with pytest.raises(CaseError, match="is closed: no frame can be added"):
        results.write(FakeSimulation())


def test_a_column_that_cannot_be_made_takes_no_room(tmp_path: Path) -> None:
    file, simulation = SlowWriter(tmp_path), Breaking()
    simulation.step = 1
    file.allowed.release(9)
    results = BackgroundWriter(file, room=1)  # One column at a time.
    with pytest.raises(MemoryError):
        results.write(simulation)
    with pytest.raises(CaseError, match="broken off"):
        results.close()
    assert results._parts._waiting == 0


def test_a_frame_that_breaks_off_leaves_those_before(tmp_path: Path) -> None:
    simulation, file = Breaking(), SlowWriter(tmp_path)
    file.allowed.release(9)
    with pytest.raises(MemoryError, match="no room"), BackgroundWriter(file) as results:
        results.write(simulation)
        simulation.advance(4)
        results.write(simulation)
    assert open_results(tmp_path).steps.tolist() == [0]


@pytest.mark.parametrize("error", ERRORS)
def test_closing_tells_a_failure_unless_there_is_another(tmp_path: Path, error: Exception) -> None:
    file = SlowWriter(tmp_path, error)
    file.allowed.release()
    with pytest.raises(type(error), match=str(error)), BackgroundWriter(file) as results:
        results.write(FakeSimulation())
    file = SlowWriter(tmp_path, error)
    file.allowed.release()
    with pytest.raises(KeyboardInterrupt), BackgroundWriter(file) as results:
        results.write(FakeSimulation())
        raise KeyboardInterrupt
