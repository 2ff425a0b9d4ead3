# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a run, drawn by a process of its own.

    python -m mpm3dpp.plots.apart FOLDER

What a picture needs, matplotlib and images of some million pixels, goes back to the system with it
and does not raise the peak of the run; and what kills it does not kill the run. It ends with the
process that started it, whose end closes its standard input.
"""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

from mpm3dpp.base import child
from mpm3dpp.base.disk import unfinished
from mpm3dpp.base.errors import RunError

_PATIENCE = 2.0  # Seconds for a process that is told to end; some libraries do not listen.


def draw_apart(folder: Path) -> str:
    """Draw the pictures of a run as `plot_results` does; return what was to be said about it.

    Raises:
        RunError: they could not be drawn, and why.
        KeyboardInterrupt: the user stopped it; no half picture is left.
    """
    try:
        process = child.start(
            "plots.apart",
            str(folder.absolute()),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            errors="replace",
        )
    except OSError as error:
        raise RunError(f"no process for them could be started ({error})") from error
    assert process.stderr is not None
    try:
        said = process.stderr.read().strip()
        process.wait()
    finally:
        _end(process)
        for ending in ("png", "gif"):
            for half in folder.glob(unfinished(Path(f"*.{ending}")).name):
                half.unlink(missing_ok=True)
    if process.returncode == 0:
        return said
    if process.returncode < 0:
        name = signal.Signals(-process.returncode).name
        raise RunError(f"the process that drew them was ended by {name}")
    raise RunError(said.splitlines()[-1] if said else "the process that drew them failed")


def _end(process: subprocess.Popen[str]) -> None:
    """End a process that may still be there."""
    process.terminate()  # Nothing to one that has ended.
    try:
        process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    for pipe in (process.stdin, process.stderr):
        if pipe is not None:
            pipe.close()


def _end_with_parent() -> None:
    os.read(0, 1)  # Not by sys.stdin, whose lock the end of the interpreter needs.
    os._exit(1)


def main(folder: str) -> None:
    """Draw; say in one sentence what went wrong."""
    for kind in (signal.SIGTERM, signal.SIGINT):  # An exception could get lost in a callback.
        signal.signal(kind, signal.SIG_DFL)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        from mpm3dpp import _core

        from .run import draw_all

        _core.return_freed_memory()
        for _ in draw_all(Path(folder), -1, None, None, None):
            gc.collect()  # Figures hold themselves.
            _core.return_freed_memory()
    except MemoryError:
        sys.exit("there is not enough memory")
    except Exception as error:
        sys.exit(str(error) or type(error).__name__)


if __name__ == "__main__":
    main(sys.argv[1])
