# SPDX-License-Identifier: BSD-3-Clause
"""An #include points to its own folder or to a lower layer; the core knows nothing of Python."""

import re
import sys
from pathlib import Path

# Folder (or file) under cpp/mpm -> layer; ARCHITECTURE.md explains the order. A subject has a
# folder of its own, of which the data may lie lower than its stages.
LAYERS = {
    "catalogue": 0,
    "math": 0,
    "parallel": 0,
    "comm": 1,
    "rigid/rigid_motion.hpp": 2,
    "rigid/prescribed_motion.hpp": 3,
    "loads/kinds": 1,
    "loads/load_kinds.hpp": 2,
    "loads/surface_load.hpp": 3,
    "loads/body_force.hpp": 1,
    "loads/damped_node.hpp": 1,
    "loads/damping.hpp": 2,
    "fields": 1,
    "basis": 1,
    "state": 2,
    "layout": 2,
    "materials": 4,
    "walls/walls.hpp": 3,
    "walls/face_impulses.hpp": 3,
    "grid": 4,
    "followers/node_table.hpp": 5,
    "followers/followers.hpp": 6,
    "surfaces/hosts.hpp": 3,
    "surfaces/opposite.hpp": 3,
    "surfaces/pressing_touches.hpp": 4,
    "surfaces/acting_on_bodies.hpp": 4,
    "surfaces/other_ranks.hpp": 4,
    "surfaces/surfaces.hpp": 5,
    "particles": 5,
    "schedule": 6,
    "contact": 6,
    "reference": 6,
    "ledger": 7,
    "domain.hpp": 8,
    "step": 9,
    "rigid": 9,
    "walls": 9,
    "loads": 9,
    "surfaces": 9,
    "followers": 9,
    "device": 10,
    "run": 11,
}
# The stages: those of a subject in its folder.
TOGETHER = {"step", "rigid", "walls", "loads", "surfaces", "followers"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"][^>"]+)[>"]')
PYTHON = re.compile(r'^[<"](nanobind/|pybind11/|Python\.h|numpy/)')


def place_in(core: Path, path: str) -> str:
    """The entry of LAYERS that holds a file, given below the core; else its folder."""
    holders = (str(p) for p in (Path(path), *Path(path).parents))
    return next((p for p in holders if p in LAYERS), Path(path).parts[0])


def target(include: str, source: Path, core: Path) -> str | None:
    """What is included, below cpp/mpm, or None if it lies outside the core."""
    bracket, name = include[0], include[1:]
    if name.startswith("mpm/"):
        return name.removeprefix("mpm/")
    if bracket == "<":
        return None
    beside = (source.parent / name).resolve()
    if beside.is_relative_to(core.resolve()):
        return str(beside.relative_to(core.resolve()))
    return None


def problem(include: str, source: Path, core: Path) -> str | None:
    """What is wrong with one include (`<name` or `"name`) of a core file, or None."""
    if PYTHON.match(include):
        return "the core must not know Python; translate in bindings/"
    path = target(include, source, core)
    if path is None:
        return None
    own = place_in(core, str(source.relative_to(core)))
    other = place_in(core, path)
    if other == own or {own, other} <= TOGETHER:
        return None
    if other not in LAYERS:
        return f"{other} has no layer: add it to tools/check_layers.py"
    if LAYERS[other] >= LAYERS[own]:
        return f"{own} is layer {LAYERS[own]}, {other} is layer {LAYERS[other]}: not lower"
    return None


def check(root: Path) -> list[str]:
    """Every violation under root/cpp/mpm, as 'file:line: include: why'."""
    core = root / "cpp" / "mpm"
    found = []
    for source in sorted([*core.rglob("*.hpp"), *core.rglob("*.cpp")]):
        own = source.relative_to(core).parts[0]
        if own not in LAYERS:
            found.append(f"{source.relative_to(root)}: {own} has no layer")
            continue
        for number, line in enumerate(source.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            why = problem(match[1], source, core) if match else None
            if why:
                found.append(f"{source.relative_to(root)}:{number}: {match[1][1:]}: {why}")
    return found


if __name__ == "__main__":
    violations = check(Path(__file__).resolve().parents[1])
    print(*violations, f"{len(violations)} includes against the layers", sep="\n")
    sys.exit(bool(violations))
