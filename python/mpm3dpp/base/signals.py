# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C (SIGINT), SIGTERM and their like, so that whenever they come a command ends, and a run is
kept.

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

_BY_USER = {signal.SIGINT, signal.SIGTERM}
# A terminal that closes, Ctrl-\, what batch systems send before a job's time is over, and the
# system before its processor time is.
_OTHERS = ("SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGXCPU")
KINDS = (
    *(signal.SIGINT, signal.SIGTERM),
    *(signal.Signals[name] for name in _OTHERS if name in signal.Signals.__members__),
)
"""All that end a command; not all systems have all."""
CODE = 130
"""Exit code of a command that was stopped: 128 + SIGINT, as shells have it."""
SENTENCE = "stopped by the user"


def sentence(kind: int | None) -> str:
    """Return what is told of a signal that has ended a command."""
    if kind is None or kind in _BY_USER:
        return SENTENCE
    return f"stopped by {signal.Signals(kind).name}"


def heeded() -> list[signal.Signals]:
    """Return the signals that end a command: not those that its starter ignores, as nohup does."""
    return [
        kind for kind in KINDS if kind in _BY_USER or signal.getsignal(kind) is not signal.SIG_IGN
    ]


def end_at_once() -> None:
    """From now on each of the signals ends the process, with a sentence."""
    for kind in heeded():
        signal.signal(kind, _end)


def _end(kind: int, _frame: object) -> None:
    with contextlib.suppress(OSError):
        os.write(2, f"mpm3dpp: error: {sentence(kind)}\n".encode())
    os._exit(CODE)


@contextlib.contextmanager
def as_exceptions() -> Iterator[None]:
    """Within it each signal raises KeyboardInterrupt where the command would end at once.

    In a program of the user's, which has its own way, nothing changes.
    """
    ours = [kind for kind in KINDS if signal.getsignal(kind) is _end]
    for kind in ours:
        signal.signal(kind, _raise)
    try:
        yield
    finally:
        for kind in ours:
            signal.signal(kind, _end)


def _raise(kind: int, _frame: object) -> None:
    raise KeyboardInterrupt(*([] if kind in _BY_USER else [sentence(kind)]))


class Notice:
    """Within it each signal is only taken notice of; a second Ctrl-C ends the process at once.

    Outside the main thread, where Python handles no signals, it does nothing. What a program of the
    user's has handlers of its own for, beside Ctrl-C and SIGTERM, is left to these.

    Attributes:
        taken: whether there was one.
        kind: the first one.
    """

    def __init__(self) -> None:
        self.kind: int | None = None
        self._old: dict[signal.Signals, object] = {}

    @property
    def taken(self) -> bool:
        return self.kind is not None

    def __enter__(self) -> Notice:
        with contextlib.suppress(ValueError):  # Not the main thread.
            for kind in KINDS:
                if kind in _BY_USER or signal.getsignal(kind) in (signal.SIG_DFL, _end):
                    self._old[kind] = signal.signal(kind, self._take)
        return self

    def __exit__(self, *_about: object) -> None:
        for kind, handler in self._old.items():
            if handler is not None:  # Else it was one of C, which Python cannot set.
                signal.signal(kind, handler)  # type: ignore[arg-type]

    def _take(self, kind: int, _frame: object) -> None:
        self.kind = self.kind or kind
        if kind in (signal.SIGINT, getattr(signal, "SIGQUIT", None)):  # Keys, pressed once more.
            signal.signal(kind, signal.SIG_DFL)
