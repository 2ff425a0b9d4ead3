# SPDX-License-Identifier: BSD-3-Clause
"""Files and functions stay small (tests aside).

A file of more than 300 lines is a warning, of more than 500 an error. A Python function of more
than 60 lines, its docstring apart, is an error; clang-tidy judges those of C++.
"""

import ast
import statistics
import sys
from pathlib import Path

from files import project_files

SOFT, HARD, MEDIAN, FUNCTION = 300, 500, 150, 60
SUFFIXES = {".hpp", ".cpp", ".py", ".cmake"}


def check(root: Path, files: list[Path]) -> tuple[list[str], list[str]]:
    """(errors, warnings) for the code files among `files`, paths relative to root."""
    code = [f for f in files if f.suffix in SUFFIXES and f.parts[0] != "tests"]
    lines = {f: len((root / f).read_text().splitlines()) for f in code}
    errors = [
        f"{f}: {n} lines, the limit is {HARD}: split it" for f, n in lines.items() if n > HARD
    ]
    errors += [text for f in code if f.suffix == ".py" for text in long_functions(root, f)]
    warnings = [
        f"{f}: {n} lines, more than {SOFT}: think of splitting it"
        for f, n in lines.items()
        if SOFT < n <= HARD
    ]
    median = statistics.median(lines.values()) if lines else 0
    if median > MEDIAN:
        warnings.append(f"the median file has {median:g} lines, more than {MEDIAN}")
    return errors, warnings


def long_functions(root: Path, file: Path) -> list[str]:
    """A sentence for each function of a Python file that is too long."""
    found = []
    for node in ast.walk(ast.parse((root / file).read_text())):
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        documented = ast.get_docstring(node) is not None
        first = node.body[1] if documented and len(node.body) > 1 else node.body[0]
        lines = (node.end_lineno or 0) - first.lineno + 1
        if lines > FUNCTION:
            found.append(f"{file}:{node.lineno}: {node.name} has {lines} lines: split it")
    return found


if __name__ == "__main__":
    top = Path(__file__).resolve().parents[1]
    too_long, long = check(top, project_files(top))
    summary = f"{len(too_long)} files or functions too long, {len(long)} warnings"
    print(*(f"warning: {text}" for text in long), *too_long, summary, sep="\n")
    sys.exit(bool(too_long))
