# SPDX-License-Identifier: BSD-3-Clause
"""How much of some work is done: a line that is rewritten, or a plain one now and then.

On a terminal it is a bar (rich; `NO_COLOR` is honoured), in a notebook one line of its output.
Elsewhere a plain line comes at every tenth of the work, at most one in two seconds and at least
one a minute.
"""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Callable
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

_REFRESH = 0.1  # Seconds between two pictures of the bar,
_REFRESH_IN_NOTEBOOK = 0.5  # and of the line of a notebook, which go through a network.
_QUIET_FOR = 2.0  # Least seconds between two plain lines.
_AT_LEAST = 60.0  # Most seconds without a plain line.
_CELLS = 20  # Of the bar in a notebook.


class ProgressLine:
    """Shows on standard error how much is done, with some words and the time that is left.

    Args:
        quiet: show nothing at all.
        stream: where to write; standard error by default.
    """

    def __init__(self, *, quiet: bool = False, stream: IO[str] | None = None) -> None:
        self._quiet = quiet
        self._stream = stream or sys.stderr
        self._bar: Bar | None = None
        self._task: TaskID | None = None
        self._notebook = in_notebook(self._stream)
        self._width = 0  # Characters of the line that stands in a notebook.
        self._start = self._shown = clock.monotonic()
        self._tenth = 0
        self._first: float | None = None

    def __enter__(self) -> ProgressLine:
        self._start = self._shown = clock.monotonic()
        if not self._quiet and self._stream.isatty():
            self._open_bar()
        return self

    def __exit__(self, *about: object) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None
        self._end_line()

    def show(self, done: float, words: Callable[[], str]) -> None:
        """Tell how much is done; cheap enough to call often.

        Args:
            done: 0 to 1; where work goes on that was begun before, the first is more than 0.
            words: gives what is said beside it; called where it is shown.
        """
        if self._quiet:
            return
        now = clock.monotonic()
        if self._first is None:
            self._first = done
        if not self._due(done, now):
            return
        self._shown, self._tenth = now, int(10 * done + 1e-9)
        left = self._left(done, now)
        if self._bar is not None and self._task is not None:
            self._bar.update(self._task, completed=done, text=words(), left=left)
        elif self._notebook:
            full = int(_CELLS * done + 1e-9)
            cells = "\N{FULL BLOCK}" * full + "\N{LIGHT SHADE}" * (_CELLS - full)
            line = f"{cells} {done:4.0%}  {left:<11}  {words()}"
            print(f"\r{line:<{self._width}}", end="", file=self._stream, flush=True)
            self._width = len(line)
        else:
            print(f"{done:4.0%}  {words()}  {left}", file=self._stream, flush=True)

    def note(self, text: str) -> None:
        """A line of its own, for example that a run was interrupted."""
        if self._quiet:
            return
        if self._bar is not None:
            self._bar.console.print(text, markup=False, highlight=False)
        else:
            self._end_line()
            print(text, file=self._stream, flush=True)

    def _due(self, done: float, now: float) -> bool:
        waited = now - self._shown
        if self._bar is not None or self._notebook:
            least = _REFRESH_IN_NOTEBOOK if self._notebook else _REFRESH
            return waited >= least or done >= 1.0
        if done >= 1.0:
            return self._tenth < 10
        return waited >= (_QUIET_FOR if int(10 * done + 1e-9) > self._tenth else _AT_LEAST)

    def _left(self, done: float, now: float) -> str:
        """Time left, from the mean speed so far; the wall time at the end."""
        spent = now - self._start
        if done >= 1.0:
            return f"took {duration(spent)}"
        made = done - (self._first or 0.0)
        if made <= 0.0 or spent < 0.5:
            return "left --"
        return f"left {duration(spent * (1.0 - done) / made)}"

    def _end_line(self) -> None:
        """End the line of a notebook, if one stands there."""
        if self._width:
            print(file=self._stream, flush=True)
            self._width = 0

    def _open_bar(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Bar
        from rich.table import Column

        def fixed(width: int) -> Column:
            return Column(no_wrap=True, min_width=width)

        # on a narrow terminal the text is cut at its end; the bar and the time left stay
        self._bar = Bar(
            BarColumn(bar_width=10, table_column=fixed(10)),
            TextColumn("{task.percentage:>3.0f}%", table_column=fixed(4)),
            TextColumn("{task.fields[left]}", style="cyan", table_column=fixed(11)),
            TextColumn("{task.fields[text]}", table_column=Column(no_wrap=True)),
            console=Console(file=self._stream),
            refresh_per_second=10,
        )
        self._task = self._bar.add_task("run", total=1.0, text="", left="")
        self._bar.start()


def in_notebook(stream: object) -> bool:
    """Return whether what is written to a stream goes to the output of a notebook's cell."""
    return "ipykernel" in sys.modules and type(stream).__module__.startswith("ipykernel")


def duration(seconds: float) -> str:
    """Hours, minutes and seconds, as one reads a clock."""
    whole = round(seconds)
    if whole < 60:
        return f"{seconds:.1f} s" if seconds < 10 else f"{whole} s"
    hours, rest = divmod(whole, 3600)
    return f"{hours}:{rest // 60:02d}:{rest % 60:02d}" if hours else f"{rest // 60}:{rest % 60:02d}"
