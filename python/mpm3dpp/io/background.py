# SPDX-License-Identifier: BSD-3-Clause
"""Frames written by a thread of its own while the simulation goes on."""

from __future__ import annotations

import contextlib
import dataclasses
import math
import queue
import threading
from collections.abc import Iterator
from typing import Any, Protocol

import numpy as np

from mpm3dpp.base.errors import CaseError

from .fields import Column
from .frames_writer import FramesWriter
from .vtkhdf import ResultsWriter

FRAME_SHARE = 1 / 6
"""Of the core's memory, the room that a run has for columns that are not written yet."""


@dataclasses.dataclass
class _Once:
    """Gives an array that has been made, and drops it."""

    array: np.ndarray | None

    def __call__(self) -> np.ndarray:
        array, self.array = self.array, None
        assert array is not None
        return array


class FrameParts(Protocol):
    """Who writes frames, or the parts of them; see `FrameThread`."""

    def hand_over(self, simulation: Any) -> None: ...
    def look(self, again: bool = False) -> tuple[int, Exception | None]: ...
    def wait(self) -> None: ...
    def sums_of_others(self) -> list[list[int]]: ...
    def end(self) -> None: ...


class FrameThread:
    """Writes frames column by column, in a thread of its own.

    The thread that steps copies a column when there is room for it beside those that are not
    written yet, so that what waits for the disk is never more than `room`, whatever the frame. A
    frame that could not be written ends the run at its next look. Frames written before stay
    readable; those that wait are dropped.

    Args:
        file: the writer of the files.
        room: for columns that are copied and not written [bytes]; one is always let in.
    """

    def __init__(self, file: FramesWriter, room: float = math.inf) -> None:
        self.file = file
        self._room = room
        self._waiting = 0  # bytes of the columns that are not written
        self._unwritten = 0  # frames
        self._changed = threading.Condition()
        # A frame, then its columns, then None in place of one more, or what went wrong with it; at
        # the end None in place of a frame.
        self._handed: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._error: Exception | None = None  # set once, by the thread that writes
        self._told = False
        self._thread = threading.Thread(target=self._work, name="frames", daemon=True)
        self._thread.start()

    def hand_over(self, simulation: Any) -> None:
        """Hand over the present state of the core's `Simulation`; wait only for room.

        Raises:
            CaseError: the thread has ended, or there is no such column.
        """
        if not self._thread.is_alive():
            raise self.file.closed()
        frame = self.file.frame_of(simulation)
        with self._changed:
            self._unwritten += 1
        self._handed.put(frame)
        end: CaseError | None = None
        try:
            for column in frame.columns:
                self._wait_for_room(column.bytes)
                try:
                    made = _Once(column.make())
                except BaseException:
                    self._give_back(column.bytes)
                    raise
                self._handed.put(column._replace(make=made))
        except BaseException:
            end = CaseError("a frame was broken off while it was copied")
            raise
        finally:
            self._handed.put(end)

    def look(self, again: bool = False) -> tuple[int, Exception | None]:
        """Return how many frames are written, and what has gone wrong with one.

        Args:
            again: what has gone wrong also if it has been told before.
        """
        error = self._error if again or not self._told else None
        self._told |= error is not None
        return self.file.frames, error

    def wait(self) -> None:
        """Wait until all that was handed over is written, or could not be."""
        with self._changed:
            self._changed.wait_for(lambda: self._unwritten == 0)

    def sums_of_others(self) -> list[list[int]]:
        """Return what `FramesWriter.finish` returns to those who write other parts: nobody here."""
        return []

    def end(self) -> None:
        """Write what waits, and end the thread. Twice does nothing."""
        if self._thread.is_alive():
            self._handed.put(None)
            self._thread.join()

    def _wait_for_room(self, size: int) -> None:
        with self._changed:
            self._changed.wait_for(lambda: self._waiting == 0 or self._waiting + size <= self._room)
            self._waiting += size

    def _give_back(self, size: int) -> None:
        with self._changed:
            self._waiting -= size
            self._changed.notify_all()

    def _taken(self) -> Iterator[Column]:
        """Take the columns of a frame as they come; each has been written when the next is."""
        while (got := self._handed.get()) is not None:
            if isinstance(got, CaseError):
                raise got
            yield got
            got.make.array = None
            self._give_back(got.bytes)

    def _work(self) -> None:
        while (frame := self._handed.get()) is not None:
            columns = self._taken()
            try:
                if self._error is None:
                    self.file.add(dataclasses.replace(frame, columns=columns))
            except Exception as error:  # Whatever it is, the thread that steps must hear of it.
                self._error = error
            finally:
                with contextlib.suppress(CaseError):
                    for _ in columns:  # Those that were not wanted.
                        pass
                with self._changed:
                    self._unwritten -= 1
                    self._changed.notify_all()


class BackgroundWriter:
    """Writes frames while the simulation goes on; a context manager that closes the file.

    `write` raises the error of a frame that could not be written, `check` and `close` do if nobody
    has told it yet.

    Args:
        results: the writer of the files, closed at the end.
        room: see `FrameThread`.
        parts: who writes them; by default a `FrameThread`.
    """

    def __init__(
        self, results: ResultsWriter, room: float = math.inf, parts: FrameParts | None = None
    ) -> None:
        self._results = results
        self._parts: FrameParts = FrameThread(results, room) if parts is None else parts

    def write(self, simulation: Any) -> None:
        """Hand over the present state of the core's `Simulation`; wait only for room.

        Raises:
            CaseError: an earlier frame could not be written, or there is no such column.
        """
        self._look(again=True)
        self._parts.hand_over(simulation)

    def rows(self) -> dict[str, Any]:
        """Write what waits, and return what a writer needs to go on from here.

        Raises:
            CaseError: a frame could not be written.
        """
        self._parts.wait()
        self._look(again=True)
        return self._results.rows(self._parts.sums_of_others())

    def check(self) -> None:
        """Raise the error of a frame that could not be written, if nobody has told it yet."""
        self._look(again=False)

    def close(self) -> None:
        """Write what waits, and close the file. Closing twice does nothing.

        Raises:
            CaseError: a frame could not be written, and nobody has told it yet.
        """
        self._parts.end()
        self._results.whole, error = self._parts.look(again=False)
        try:
            self._results.close()
        finally:
            if error is not None:
                raise error

    def __enter__(self) -> BackgroundWriter:
        return self

    def __exit__(self, kind: type[BaseException] | None, *about: object) -> None:
        # The first error is the one to tell.
        with contextlib.suppress(Exception) if kind else contextlib.nullcontext():
            self.close()

    def _look(self, again: bool) -> None:
        self._results.whole, error = self._parts.look(again)
        if error is not None:
            raise error
