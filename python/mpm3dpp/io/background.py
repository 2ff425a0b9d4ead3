# SPDX-License-Identifier: BSD-3-Clause
"""Frames written by a thread of its own while the simulation goes on."""

from __future__ import annotations

import contextlib
import queue
import threading
from typing import Any

from mpm3dpp.io.fields import Frame
from mpm3dpp.io.vtkhdf import ResultsWriter

BEHIND = 2
"""Frames that may be copied and not yet written before a step waits for the disk."""


class BackgroundWriter:
    """Writes frames from copies, in a thread of its own; a context manager that ends it.

    A frame that could not be written ends the run at its next look: `write` raises the error,
    `check` and `close` do if nobody has told it yet. Frames written before stay readable; those
    that wait are dropped.

    Args:
        results: the writer of the file, closed at the end.
    """

    def __init__(self, results: ResultsWriter) -> None:
        self._results = results
        self._frames: queue.SimpleQueue[Frame | None] = queue.SimpleQueue()
        self._room = threading.Semaphore(BEHIND)
        self._error: Exception | None = None  # set once, by the thread that writes
        self._told = False
        self._thread = threading.Thread(target=self._work, name="frames", daemon=True)
        self._thread.start()

    def write(self, simulation: Any) -> None:
        """Hand over a copy of the core's `Simulation`; wait only while two others are not written.

        Raises:
            CaseError: an earlier frame could not be written, or there is no such column.
        """
        self._room.acquire()
        try:
            self._tell()
            self._frames.put(self._results.copy(simulation))
        except BaseException:
            self._room.release()
            raise

    def rows(self) -> dict[str, Any]:
        """Write what waits, and return what a writer needs to go on from here.

        Raises:
            CaseError: a frame could not be written.
        """
        for _ in range(BEHIND):
            self._room.acquire()
        self._room.release(BEHIND)
        self._tell()
        return self._results.rows()

    def check(self) -> None:
        """Raise the error of a frame that could not be written, if nobody has told it yet."""
        if not self._told:
            self._tell()

    def close(self) -> None:
        """Write what waits, and close the file. Closing twice does nothing.

        Raises:
            CaseError: a frame could not be written, and nobody has told it yet.
        """
        if self._thread.is_alive():
            self._frames.put(None)
            self._thread.join()
        try:
            self._results.close()
        finally:
            self.check()

    def __enter__(self) -> BackgroundWriter:
        return self

    def __exit__(self, kind: type[BaseException] | None, *about: object) -> None:
        # The first error is the one to tell.
        with contextlib.suppress(Exception) if kind else contextlib.nullcontext():
            self.close()

    def _tell(self) -> None:
        if self._error is not None:
            self._told = True
            raise self._error

    def _work(self) -> None:
        while (frame := self._frames.get()) is not None:
            try:
                if self._error is None:
                    self._results.add(frame)
            except Exception as error:  # Whatever it is, the thread that steps must hear of it.
                self._error = error
            finally:
                self._room.release()
