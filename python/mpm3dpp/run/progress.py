# SPDX-License-Identifier: BSD-3-Clause
"""How far a run is: a live bar on a terminal, a plain line now and then elsewhere."""

from __future__ import annotations

import sys
import time as clock
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

_REFRESH = 0.1  # seconds between two pictures of the bar
_QUIET_FOR = 2.0  # least seconds between two plain lines
_AT_LEAST = 60.0  # most seconds without a plain line


class Progress:
    """Shows time, step size, energies and contact of a run on standard error.

    On a terminal: one line that is redrawn, with a bar and the time left (rich; `NO_COLOR` is
    honoured). Elsewhere: one plain line at every tenth of the run, at most one in two seconds
    and at least one a minute. Standard output stays free for `--json`.

    Args:
        end_time: time at which the run ends [s].
        quiet: show nothing at all.
        energy_unit: "J", or "J/m" in two dimensions.
        stream: where to write; standard error by default.
    """

    def __init__(
        self,
        end_time: float,
        *,
        quiet: bool = False,
        energy_unit: str = "J",
        stream: IO[str] | None = None,
    ) -> None:
        self._end = end_time
        self._quiet = quiet
        self._unit = energy_unit
        self._stream = stream or sys.stderr
        self._bar: Bar | None = None
        self._task: TaskID | None = None
        self._start = self._shown = clock.monotonic()
        self._tenth = 0
        self._first: float | None = None

    def __enter__(self) -> Progress:
        self._start = self._shown = clock.monotonic()
        if not self._quiet and self._stream.isatty():
            self._open_bar()
        return self

    def __exit__(self, *about: object) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None

    def update(
        self,
        time: float,
        step: int,
        dt: float,
        kinetic: float,
        internal: float,
        contacts: int | None = None,
    ) -> None:
        """Tell where the run is; cheap enough to call at every step.

        Args:
            time: reached [s].
            step: steps made.
            dt: present time step [s].
            kinetic, internal: energies [J], J per metre in two dimensions.
            contacts: overlapped nodes; None for a run without contact.
        """
        if self._quiet:
            return
        now = clock.monotonic()
        if self._first is None:
            self._first = time  # a restarted run does not begin at zero
        done = min(1.0, max(0.0, time / self._end)) if self._end > 0 else 1.0
        if self._bar is not None and self._task is not None:
            if now - self._shown >= _REFRESH or done >= 1.0:
                self._shown = now
                text = self._text(time, step, dt, kinetic, internal, contacts)
                self._bar.update(self._task, completed=done, text=text, left=self._left(time, now))
            return
        tenth = int(10 * done + 1e-9)
        waited = now - self._shown
        if done < 1.0 and waited < (_QUIET_FOR if tenth > self._tenth else _AT_LEAST):
            return
        if done >= 1.0 and self._tenth == 10:
            return
        self._shown, self._tenth = now, tenth
        text = self._text(time, step, dt, kinetic, internal, contacts)
        print(f"{done:4.0%}  {text}  {self._left(time, now)}", file=self._stream, flush=True)

    def note(self, text: str) -> None:
        """A line of its own, for example that a run was interrupted."""
        if self._quiet:
            return
        if self._bar is not None:
            self._bar.console.print(text, markup=False, highlight=False)
        else:
            print(text, file=self._stream, flush=True)

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

    def _left(self, time: float, now: float) -> str:
        """Time left, from the mean speed so far; the wall time at the end."""
        spent = now - self._start
        if time >= self._end:
            return f"took {_duration(spent)}"
        made = time - (self._first or 0.0)
        if made <= 0.0 or spent < 0.5:
            return "left --"
        return f"left {_duration(spent * (self._end - time) / made)}"

    def _text(
        self,
        time: float,
        step: int,
        dt: float,
        kinetic: float,
        internal: float,
        contacts: int | None,
    ) -> str:
        parts = [
            f"t {_short(time, 's', 4)}",
            f"dt {_short(dt, 's')}",
            f"kinetic {_short(kinetic, self._unit)}",
            f"internal {_short(internal, self._unit)}",
        ]
        if contacts is not None:
            parts.append(f"contact {contacts} nodes")
        parts.append(f"step {step}")
        return "  ".join(parts)


def _duration(seconds: float) -> str:
    """Hours, minutes and seconds, as one reads a clock."""
    whole = round(seconds)
    if whole < 60:
        return f"{seconds:.1f} s" if seconds < 10 else f"{whole} s"
    hours, rest = divmod(whole, 3600)
    return f"{hours}:{rest // 60:02d}:{rest % 60:02d}" if hours else f"{rest // 60}:{rest % 60:02d}"


def _short(value: float, unit: str, digits: int = 3) -> str:
    """A value with its prefix, for example `1.25 ms`."""
    from mpm3dpp.plots.labels import scaled

    return scaled(value, unit, digits)
