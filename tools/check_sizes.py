# SPDX-License-Identifier: BSD-3-Clause
"""Files stay small: more than 300 lines is a warning, more than 500 an error (tests aside)."""

import statistics
import sys
from pathlib import Path

from files import project_files

SOFT, HARD, MEDIAN = 300, 500, 150
SUFFIXES = {".hpp", ".cpp", ".py", ".cmake"}


def check(root: Path, files: list[Path]) -> tuple[list[str], list[str]]:
    """(errors, warnings) for the code files among `files`, paths relative to root."""
    code = [f for f in files if f.suffix in SUFFIXES and f.parts[0] != "tests"]
    lines = {f: len((root / f).read_text().splitlines()) for f in code}
    errors = [
        f"{f}: {n} lines, the limit is {HARD}: split it" for f, n in lines.items() if n > HARD
    ]
    warnings = [
        f"{f}: {n} lines, more than {SOFT}: think of splitting it"
        for f, n in lines.items()
        if SOFT < n <= HARD
    ]
    median = statistics.median(lines.values()) if lines else 0
    if median > MEDIAN:
        warnings.append(f"the median file has {median:g} lines, more than {MEDIAN}")
    return errors, warnings


if __name__ == "__main__":
    top = Path(__file__).resolve().parents[1]
    too_long, long = check(top, project_files(top))
    summary = f"{len(too_long)} files too long, {len(long)} warnings"
    print(*(f"warning: {text}" for text in long), *too_long, summary, sep="\n")
    sys.exit(bool(too_long))
