# SPDX-License-Identifier: BSD-3-Clause
"""An #include points to its own folder or to a lower layer; the core knows nothing of Python."""

import re
import sys
from pathlib import Path

# Folder (or file) directly under cpp/mpm -> layer; DESIGN and ARCHITECTURE.md explain the order.
LAYERS = {
    "catalogue": 0,
    "math": 0,
    "parallel": 0,
    "fields": 1,
    "basis": 1,
    "layout": 2,
    "materials": 3,
    "grid": 3,
    "particles": 4,
    "schedule": 5,
    "contact": 5,
    "reference": 5,
    "ledger": 6,
    "domain.hpp": 7,
    "step": 8,
    "run": 9,
}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"][^>"]+)[>"]')
PYTHON = re.compile(r'^[<"](nanobind/|pybind11/|Python\.h|numpy/)')


def target_folder(include: str, source: Path, core: Path) -> str | None:
    """First part under cpp/mpm of what is included, or None if it lies outside the core."""
    bracket, name = include[0], include[1:]
    if name.startswith("mpm/"):
        return Path(name).parts[1]
    if bracket == "<":
        return None
    beside = (source.parent / name).resolve()
    if beside.is_relative_to(core.resolve()):
        return beside.relative_to(core.resolve()).parts[0]
    return None


def problem(include: str, source: Path, core: Path) -> str | None:
    """What is wrong with one include (`<name` or `"name`) of a core file, or None."""
    if PYTHON.match(include):
        return "the core must not know Python; translate in bindings/"
    own = source.relative_to(core).parts[0]
    other = target_folder(include, source, core)
    if other is None or other == own:
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
