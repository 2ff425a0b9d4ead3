# SPDX-License-Identifier: BSD-3-Clause
"""An import points to its own package or to a lower layer, and modules import in no circle."""

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

# Package of mpm3dpp -> layer; ARCHITECTURE.md explains the order.
LAYERS = {
    "base": 0,
    "ranks": 1,
    "materials": 1,
    "shapes": 1,
    "grains": 2,
    "case": 3,
    "importers": 4,
    "manual": 4,
    "fill": 4,
    "io": 5,
    "plots": 6,
    "run": 7,
    "material_test": 7,
    "bench": 8,
    "sweep": 8,
    "reports": 8,
    "validate": 8,
    "reproduce": 9,
    "cli": 10,
}
FOR_ALL = {"_core"}  # the compiled core


def module_of(file: Path, package: Path) -> tuple[str, ...]:
    """The parts of a module's name below mpm3dpp; () for the top."""
    parts = file.relative_to(package).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


def imports(tree: ast.AST, for_types: bool = False) -> Iterator[tuple[ast.ImportFrom, bool]]:
    """Each `from ... import`, and whether only a type checker sees it."""
    for node in ast.iter_child_nodes(tree):
        only_types = for_types or (
            isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
        )
        if isinstance(node, ast.ImportFrom):
            yield node, only_types
        else:
            yield from imports(node, only_types)


def targets(
    node: ast.ImportFrom, file: Path, package: Path, known: set[tuple[str, ...]]
) -> list[tuple[str, ...]]:
    """The modules of ours that an import names."""
    name = tuple((node.module or "").split(".")) if node.module else ()
    if node.level:
        here = file.relative_to(package).parent.parts
        base = here[: len(here) - node.level + 1] + name
    elif name[:1] == (package.name,):
        base = name[1:]
    else:
        return []
    return [(*base, a.name) if (*base, a.name) in known else base for a in node.names]


def circle(graph: dict[tuple[str, ...], set[tuple[str, ...]]]) -> list[str]:
    """The first circle that is found, module by module; empty if there is none."""
    done: set[tuple[str, ...]] = set()
    way: list[tuple[str, ...]] = []

    def visit(module: tuple[str, ...]) -> list[str]:
        if module in way:
            return [".".join(m) for m in (*way[way.index(module) :], module)]
        if module in done:
            return []
        way.append(module)
        for other in sorted(graph.get(module, ())):
            if found := visit(other):
                return found
        way.pop()
        done.add(module)
        return []

    return next((found for module in sorted(graph) if (found := visit(module))), [])


def check(root: Path) -> list[str]:
    """Every violation under root/python/mpm3dpp, as 'file:line: why'; the top is free."""
    package = root / "python" / "mpm3dpp"
    files = sorted(package.rglob("*.py"))
    known = {module_of(file, package) for file in files}
    found, graph = [], {}
    for file in files:
        module = module_of(file, package)
        if not module or len(file.relative_to(package).parts) == 1:
            continue
        if module[0] not in LAYERS:
            found.append(f"{file.relative_to(root)}:1: {module[0]} has no layer")
            continue
        runs: set[tuple[str, ...]] = set()
        for node, only_types in imports(ast.parse(file.read_text())):
            for target in targets(node, file, package, known):
                if not target or target[0] in FOR_ALL or target == module:
                    continue
                if not only_types:
                    runs.add(target)
                own, other = LAYERS[module[0]], LAYERS.get(target[0])
                if target[0] != module[0] and (other is None or other >= own):
                    why = f"{module[0]} is layer {own}, {target[0]} is layer {other}: not lower"
                    found.append(f"{file.relative_to(root)}:{node.lineno}: {why}")
        graph[module] = runs
    if loop := circle(graph):
        found.append(f"modules import each other: {' -> '.join(loop)}")
    return found


if __name__ == "__main__":
    violations = check(Path(__file__).resolve().parents[1])
    print(*violations, f"{len(violations)} imports against the layers", sep="\n")
    sys.exit(bool(violations))
