# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp` from its first moment: signals and streams, then the command line.

Exit codes: 0 done, 1 the run had to stop, 2 a mistake in the case or on the command line, 130
stopped by the user.
"""

from __future__ import annotations

import contextlib
import errno
import io
import os
import sys
import traceback

from mpm3dpp.base import signals
from mpm3dpp.base.start import forget_folder

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mpm3dpp.base.errors import CaseError

_MOST_TOLD = 50  # Mistakes that are listed.


def main() -> None:
    """Run the command line and exit; a mistake is a sentence, never a traceback."""
    forget_folder()
    signals.end_at_once()
    _mend_streams()
    os.environ["MPLBACKEND"] = "agg"  # Pictures go into files, whatever the user's notebooks need.
    from mpm3dpp.ranks.launcher import started

    found = started()
    if found is None:
        _command()
    elif sys.argv[1:2] and sys.argv[1] in _STARTS_OTHERS:
        _refuse(sys.argv[1], first=found[1] == 0)
    else:
        _one_of_many()


_STARTS_OTHERS = {
    "bench": "; for ranks give it --ranks",
    "reproduce": "",
    "study": "; for runs beside each other give it --jobs",
    "sweep": "; for runs beside each other give it --jobs",
    "validate": "",
}
"""Commands that start processes of their own, which would take themselves for ranks; what to do."""


def _refuse(command: str, first: bool) -> None:
    """Say that a command is not for mpiexec, once, and exit."""
    from mpm3dpp.base.errors import CaseError

    if first:
        remedy = f"leave mpiexec out{_STARTS_OTHERS[command]}"
        _tell(CaseError(f"{command} starts its runs itself, and mpiexec has started it", remedy))
    sys.exit(2)


def _one_of_many() -> None:
    """Run the command in the first of the processes that mpiexec has started, and exit."""
    from mpm3dpp.base.errors import CaseError
    from mpm3dpp.ranks.launch import exit_code, note_begin
    from mpm3dpp.ranks.world import world

    try:
        ranks = world()
    except CaseError as error:
        _tell(error)
        sys.exit(exit_code(2))
    from mpm3dpp.run.lead import dismiss, serve

    if ranks is not None and ranks.rank > 0:
        serve(ranks)
        sys.exit(0)
    note_begin()
    code = 0
    try:
        _command()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:  # Ours to mend; the others must not wait for ever.
        traceback.print_exc()
        code = 1
    dismiss()
    sys.exit(exit_code(code))


def _command() -> None:
    """Run the command line and exit."""
    from mpm3dpp.base.errors import CaseError, RunError

    try:
        from .app import app

        app()
    except CaseError as error:
        _tell(error)
        sys.exit(2)
    except RunError as error:
        _say(f"error: {error}")
        sys.exit(1)
    except KeyboardInterrupt as stopped:
        _say(f"error: {str(stopped) or signals.SENTENCE}")
        sys.exit(signals.CODE)
    except OSError as error:
        _refused(error)
        sys.exit(1)
    except MemoryError:
        _say("error: there is not enough memory; give a larger grid.cell_size")
        sys.exit(1)


class _OutputError(OSError):
    """Standard output is full or gone."""


class _Output(io.TextIOWrapper):
    """Standard output, whose errors are known from those of files."""

    def write(self, text: str) -> int:
        try:
            return super().write(text)
        except OSError as error:
            raise _OutputError(error.errno, error.strerror) from error

    def flush(self) -> None:
        try:
            super().flush()
        except OSError as error:
            raise _OutputError(error.errno, error.strerror) from error


class _Lenient(io.TextIOWrapper):
    """Standard error that may be full or gone: what cannot be told there does not end a run."""

    def write(self, text: str) -> int:
        try:
            return super().write(text)
        except OSError:
            return len(text)

    def flush(self) -> None:
        with contextlib.suppress(OSError):
            super().flush()


def _mend_streams() -> None:
    """Make standard output and error such that writing to them is no mistake of its own."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:  # Closed: the next file would get this number, and what is printed.
            os.open(os.devnull, os.O_RDWR)
    if sys.stdout is None:
        sys.stdout = os.fdopen(1, "w", encoding="utf-8", closefd=False)
    if sys.stderr is None:
        sys.stderr = os.fdopen(2, "w", encoding="utf-8", closefd=False)
    # A name that the terminal's encoding does not have is shown by its numbers.
    if isinstance(sys.stdout, io.TextIOWrapper):
        encoding, by_line = sys.stdout.encoding, sys.stdout.line_buffering
        sys.stdout = _Output(
            sys.stdout.detach(), encoding, errors="backslashreplace", line_buffering=by_line
        )
    if isinstance(sys.stderr, io.TextIOWrapper):
        encoding = sys.stderr.encoding
        sys.stderr = _Lenient(
            sys.stderr.detach(), encoding, errors="backslashreplace", line_buffering=True
        )


def _say(sentence: str) -> None:
    print(f"mpm3dpp: {sentence}", file=sys.stderr, flush=True)


def _tell(error: CaseError) -> None:
    """Print a mistake and those found with it."""
    every = [error, *error.others]
    for one in every[:_MOST_TOLD]:
        _say(f"error: {one}")
    if len(every) > 1:
        rest = f", the first {_MOST_TOLD} of which are listed" if len(every) > _MOST_TOLD else ""
        _say(f"{len(every)} mistakes{rest}")


def _refused(error: OSError) -> None:
    """Say what the system refused: standard output, or a file by its name."""
    reason = (error.strerror or str(error) or "unknown reason").lower()
    if isinstance(error, _OutputError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # What is left is not tried again at the end.
        if error.errno != errno.EPIPE:  # Else nobody reads any more, `mpm3dpp ... | head`.
            _say(f"error: cannot write to standard output: {reason}")
    elif error.filename is not None:
        _say(f"error: cannot use '{error.filename}': {reason}")
    else:
        _say(f"error: {reason}")
