# SPDX-License-Identifier: BSD-3-Clause
"""What acts on the bodies of a case, in words: the part of the echo that is not matter."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mpm3dpp.base.expression import Expression
from mpm3dpp.base.frames import MATERIAL, UPDATED
from mpm3dpp.base.time_functions import TimeFunction, highest
from mpm3dpp.case.box import CONTACT, FACES
from mpm3dpp.case.case import Case
from mpm3dpp.case.dampings import dampings_of
from mpm3dpp.case.grid import GridCoarsening
from mpm3dpp.case.initial import GEOSTATIC, Initial
from mpm3dpp.case.initial_fields import STRESS
from mpm3dpp.case.loads import KINDS
from mpm3dpp.case.parts import ContactPair
from mpm3dpp.plots.labels import scaled

Quantity = float | TimeFunction | Expression

_NAMES_SHOWN = 4
_IN_BODY = f'frame: "{MATERIAL}" for {{}}: nodes lie in each body and keep its motion'


def in_words(value: Quantity, unit: str) -> str:
    """Return a quantity: `2 mm/s`, `0 Pa to 5 MPa from 0 s to 1 ms`, `2 * x mm/s`."""
    if isinstance(value, Expression):
        return f"{value.text} {value.unit}"
    if not isinstance(value, TimeFunction):
        return _number(value, unit)
    parts = []
    if value.times:
        first, last = (_number(v, unit) for v in (value.values[0], value.values[-1]))
        span = " to ".join(_number(t, "s") for t in (value.times[0], value.times[-1]))
        if len(value.values) == 2:
            parts.append(f"{first} to {last} from {span}")
        else:
            least, most = (_number(f(value.values), unit) for f in (min, max))
            parts.append(f"{len(value.values)} values of {least} to {most} from {span}")
    if value.mean:
        parts.append(_number(value.mean, unit))
    if value.amplitude:
        wave = f"{_number(value.amplitude, unit)} sin at {_number(value.frequency, 'Hz')}"
        phase = f" and {math.degrees(value.phase):g} deg" if value.phase else ""
        parts.append(wave + phase)
    return " + ".join(parts) or _number(0.0, unit)


def vector_in_words(values: Sequence[Quantity], unit: str) -> str:
    """Return the components of a vector that may depend on time or place."""
    return f"({', '.join(in_words(value, unit) for value in values)})"


def _number(value: float, unit: str) -> str:
    return scaled(value, unit, 6).strip() if value else f"0 {unit}"


def chosen_frames(case: Case) -> list[str]:
    """Return a line for each choice of a frame: for which bodies, and why it is "updated"."""
    names: dict[str, list[str]] = {}
    for name, why in case.why_in_space.items():
        names.setdefault(why, []).append(name)
    lines = []
    for why, found in names.items():
        more = len(found) - _NAMES_SHOWN
        whose = ", ".join(found[:_NAMES_SHOWN]) + (f" and {more} more" if more > 0 else "")
        lines.append(f'frame: "{UPDATED}" for {whose}, as {why}' if why else _IN_BODY.format(whose))
    return lines


def motion_in_words(case: Case, body: str) -> str:
    """Return `, fixed`, or with what velocity a body moves as prescribed; nothing if it is free."""
    motion = case.body[body].motion
    if motion is None:
        return ""
    if not motion.moves:
        return ", fixed"
    parts = []
    if motion.velocity:
        parts.append(f"velocity {vector_in_words(motion.velocity, 'm/s')}")
    if motion.angular_velocity:
        parts.append(f"spin {vector_in_words(motion.angular_velocity, 'rad/s')}")
    return f", moves as prescribed: {', '.join(parts)}"


def load_in_words(case: Case, name: str) -> str:
    """Return the kind of a load and its value."""
    load = case.load[name]
    kind, value = load.value()
    unit = KINDS[kind]["unit"]
    if len(value) == 1:
        return f"{kind} {in_words(value[0], unit)}"
    return f"{kind} {vector_in_words(value, unit)}"


def coarsenings(cells: Sequence[int] | None, coarsening: GridCoarsening) -> int:
    """Return how often the cells can double: a box is cut into even numbers of cells each time."""
    possible = coarsening.times
    for count in cells or ():
        possible = min(possible, (count & -count).bit_length() - 1)
    return possible


def condition_lines(case: Case) -> list[str]:
    """Return what holds, drives and removes the bodies: one line for each kind."""
    grid, lines = case.grid, []
    if grid.box is not None:
        faces = FACES[: 2 * grid.dimension]
        kinds = {face: getattr(grid.box.walls, face) for face in faces}
        for face, mu in zip(faces, grid.wall_friction(case.contact.friction), strict=False):
            if kinds[face] == CONTACT:
                kinds[face] += f" with friction {mu:g}" if mu > 0.0 else " without friction"
        same = set(kinds.values())
        each = ", ".join(f"{face} {kind}" for face, kind in kinds.items())
        lines.append(f"walls: {f'all {same.pop()}' if len(same) == 1 else each}")
    if grid.outflow_box is not None:
        limits = []
        for axis, low, high in zip("xyz", *grid.kept, strict=False):
            limits += [f"{axis} > {low:g} m"] if math.isfinite(low) else []
            limits += [f"{axis} < {high:g} m"] if math.isfinite(high) else []
        lines.append(f"outflow box: {', '.join(limits)}; particles outside are taken out")
    if grid.coarsening is not None:
        limits = []
        if grid.coarsening.tiles is not None:
            limits.append(f"{grid.coarsening.tiles:,} tiles")
        if grid.coarsening.bytes is not None:
            limits.append(f"{grid.coarsening.bytes / 2**20:,.4g} MiB of nodes")
        times = coarsenings(grid.box_cells, grid.coarsening)
        lines.append(
            f"coarsening: beyond {' or '.join(limits)}, {times} times at most, to cells of "
            f"{grid.cell_size * 2**times:.4g} m"
        )
    if any(case.run.gravity):
        lines.append(f"gravity: {vector_in_words(case.run.gravity, 'm/s^2')}")
    if (settle := case.run.settle) is not None:
        lines.append(
            f"settles before t = 0, for {_number(settle.longest, 's')} at most, with local damping "
            f"{settle.local:g} until {settle.ratio:g} of the forces are out of balance"
        )
    for name, part in case.parts().items():
        if part.body_force is not None:
            force = vector_in_words(part.body_force, "m/s^2")
            lines.append(f"body force on {name}: {force}")
        if part.force is not None:
            per_metre = "/m" if case.grid.dimension == 2 else ""
            lines.append(f"force on {name}: {vector_in_words(part.force, 'N' + per_metre)}")
    for name, body in case.body.items():
        if begins := _initial_in_words(body.initial):
            lines.append(f"at the start of {name}: {begins}")
    for name in case.materials_used:
        if beta := case.material[name].beta:
            lines.append(f"damping of {name}: {_number(beta, 's')} times its stiffness")
    for damping, parts in dampings_of(case):
        words = [in_words(damping.mass, "1/s")] if highest(damping.mass) else []
        words += [f"local {in_words(damping.local, '').strip()}"] if highest(damping.local) else []
        if words:
            lines.append(f"damping of {', '.join(parts)}: {' and '.join(words)}")
    for pair in case.contact.pair if case.contact_enabled else ():
        names = pair.bodies or [f"all {name}" for name in pair.materials or ()]
        lines.append(f"{_pair_in_words(pair)} {' and '.join(names)}")
    return lines


def _pair_in_words(pair: ContactPair) -> str:
    """Return `bonded:`, or `friction: 0.3, restitution: 0.5 between`."""
    given = [
        f"{name}: {value:g}"
        for name, value in (("friction", pair.friction), ("restitution", pair.restitution))
        if value is not None
    ]
    return "bonded:" if pair.bonded else f"{', '.join(given)} between"


def _initial_in_words(initial: Initial | None) -> str:
    """Return what a body begins with; "" for nothing."""
    if initial is None:
        return ""
    words = [f"{column} by the case" for column in initial.state]
    if initial.stress == GEOSTATIC:
        K0 = "nu / (1 - nu)" if initial.K0 is None else f"{initial.K0:g}"
        words.insert(0, f"geostatic stress, K0 {K0}")
    elif initial.stress is not None:
        words.insert(0, "a stress by the case")
    if initial.fields is not None:
        fields = initial.fields
        names = dict.fromkeys("stress" if n.startswith(STRESS) else n for n in fields.columns)
        words.append(f"{' and '.join(names)} by {len(fields.positions):,} places of {fields.file}")
    return ", ".join(words)
