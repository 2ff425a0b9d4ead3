# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C (SIGINT) and SIGTERM, so that whenever they come a command ends, and a run is kept.

Python's own way, an exception wherever the program is, gets lost where that is a callback (of the
garbage collector, of an import, of a library in C), for exceptions end there. So the command does
without: it ends at once where there is nothing to lose, and a run only takes notice, and ends with
the step that it is making. This file imports nothing slow: it comes before all else.
"""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Iterator

KINDS = (signal.SIGINT, signal.SIGTERM)
CODE = 130
"""Exit code of a command that was stopped: 128 + SIGINT, as shells have it."""
SENTENCE = "stopped by the user"


def end_at_once() -> None:
    """From now on either signal ends the process, with a sentence."""
    for kind in KINDS:
        signal.signal(kind, _end)


def _end(*_about: object) -> None:
    with contextlib.suppress(OSError):
        os.write(2, f"mpm3dpp: error: {SENTENCE}\n".encode())
    os._exit(CODE)


@contextlib.contextmanager
def as_exceptions() -> Iterator[None]:
    """Within it either signal raises KeyboardInterrupt where the command would end at once.

    In a program of the user's, which has its own way, nothing changes.
    """
    ours = [kind for kind in KINDS if signal.getsignal(kind) is _end]
    for kind in ours:
        signal.signal(kind, signal.default_int_handler)
    try:
        yield
    finally:
        for kind in ours:
            signal.signal(kind, _end)


class Notice:
    """Within it either signal is only taken notice of; a second Ctrl-C ends the process at once.

    Outside the main thread, where Python handles no signals, it does nothing.

    Attributes:
        taken: whether there was one.
    """

    def __init__(self) -> None:
        self.taken = False
        self._old: dict[signal.Signals, object] = {}

    def __enter__(self) -> Notice:
        with contextlib.suppress(ValueError):  # Not the main thread.
            for kind in KINDS:
                self._old[kind] = signal.signal(kind, self._take)
        return self

    def __exit__(self, *_about: object) -> None:
        for kind, handler in self._old.items():
            if handler is not None:  # Else it was one of C, which Python cannot set.
                signal.signal(kind, handler)  # type: ignore[arg-type]

    def _take(self, kind: int, _frame: object) -> None:
        self.taken = True
        if kind == signal.SIGINT:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
