# SPDX-License-Identifier: BSD-3-Clause
"""How far a run is: a live bar in a terminal or notebook, a plain line now and then elsewhere."""

from __future__ import annotations

from typing import IO

from mpm3dpp.base.progress import ProgressLine


class Progress:
    """Shows time, step size, energies and contact of a run on standard error.

    On a terminal and in a notebook: one line that is redrawn, with a bar and the time left.
    Elsewhere: one plain line at every tenth of the run; see `base.progress`. Standard output
    stays free for `--json`.

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
        self._unit = energy_unit
        self._line = ProgressLine(quiet=quiet, stream=stream)

    def __enter__(self) -> Progress:
        self._line.__enter__()
        return self

    def __exit__(self, *about: object) -> None:
        self._line.__exit__(*about)

    def update(
        self,
        time: float,
        step: int,
        dt: float,
        kinetic: float,
        internal: float,
        contacts: tuple[int, str] | None = None,
    ) -> None:
        """Tell where the run is; cheap enough to call at every step.

        Args:
            time: reached [s].
            step: steps made.
            dt: present time step [s].
            kinetic, internal: energies [J], J per metre in two dimensions.
            contacts: overlapped nodes, or points of surfaces in touch, and the word for them; None
                for a run without contact.
        """
        done = min(1.0, max(0.0, time / self._end)) if self._end > 0 else 1.0
        self._line.show(done, lambda: self._text(time, step, dt, kinetic, internal, contacts))

    def note(self, text: str) -> None:
        """A line of its own, for example that a run was interrupted."""
        self._line.note(text)

    def _text(
        self,
        time: float,
        step: int,
        dt: float,
        kinetic: float,
        internal: float,
        contacts: tuple[int, str] | None,
    ) -> str:
        parts = [
            f"t {_short(time, 's', 4)}",
            f"dt {_short(dt, 's')}",
            f"kinetic {_short(kinetic, self._unit)}",
            f"internal {_short(internal, self._unit)}",
        ]
        if contacts is not None:
            parts.append(f"contact {contacts[0]} {contacts[1]}")
        parts.append(f"step {step}")
        return "  ".join(parts)


def _short(value: float, unit: str, digits: int = 3) -> str:
    """A value with its prefix, for example `1.25 ms`."""
    from mpm3dpp.plots.labels import scaled

    return scaled(value, unit, digits)
