# SPDX-License-Identifier: BSD-3-Clause
"""A process that ends with the one that has started it, whatever has ended that."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import threading
import time

_LOOK = 1.0  # Seconds between two looks, where the system does not tell.


def end_with(other: int, is_parent: bool, patience: float | None = None) -> None:
    """From now on this process ends when another one does, as by SIGTERM, a run with a checkpoint.

    A thread waits for it. (Linux can send a signal when a parent ends, but does so when that one's
    thread ends, which may be sooner; and it knows no other process.)

    Args:
        other: number of the process.
        is_parent: whether it is the one that has started this one.
        patience: after so many seconds this one is killed, if it is still there [s].
    """
    handle = None
    with contextlib.suppress(OSError, AttributeError):  # It has ended; no Linux, or an old one.
        handle = os.pidfd_open(other)
    about = (handle, other, is_parent, patience)
    threading.Thread(target=_wait, args=about, daemon=True).start()


def _wait(handle: int | None, other: int, is_parent: bool, patience: float | None) -> None:
    if handle is not None and _is_there(other, is_parent):  # Else its number may be another's now.
        waiting = select.poll()
        waiting.register(handle, select.POLLIN)
        waiting.poll()
    while handle is None and _is_there(other, is_parent):
        time.sleep(_LOOK)
    os.kill(os.getpid(), signal.SIGTERM)
    if patience is not None:
        time.sleep(patience)
        os.kill(os.getpid(), signal.SIGKILL)


def _is_there(other: int, is_parent: bool) -> bool:
    if is_parent:
        return other == os.getppid()
    try:
        os.kill(other, 0)
    except ProcessLookupError:
        return False
    except OSError:  # It is there, and another user's.
        return True
    return True
