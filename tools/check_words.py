# SPDX-License-Identifier: BSD-3-Clause
"""No unfinished work without an issue number, no commented-out code, no path of one machine."""

import ast
import re
import sys
from pathlib import Path

from files import project_files

BUILD_TEXT = {"", ".toml", ".cmake", ".txt", ".json", ".yaml", ".cff", ".sh"}
TEXT = {".hpp", ".cpp", ".py", ".md"} | BUILD_TEXT
UNFINISHED = re.compile(r"\b(T[O]DO|F[I]XME|X[X]X|H[A]CK)\b")  # [] so as not to find itself
ISSUE = re.compile(r"#\d+")
MACHINE_PATH = re.compile(r"(?<![\w.}/])/(?:home|root|work|farm|mnt|Users|scratch)/\w")
CPP_CODE = re.compile(r"^\s*//(?!/)\s?.*(?:;|\)\s*\{|^\s*//\s*\})\s*$")
CPP_PROSE = re.compile(r"^\s*//.*(?:\b(?:the|is|are|and|a|of|to)\b|: )")
CODE = (ast.Assign, ast.AugAssign, ast.Import, ast.ImportFrom, ast.Return, ast.Assert, ast.Raise)
PYTHON_COMMENT = re.compile(r"^\s*#\s(.+)$")


def is_python_code(text: str) -> bool:
    """True if a comment's text parses as an assignment, call, import or return."""
    try:
        body = ast.parse(text.strip()).body
    except SyntaxError:
        return False
    if len(body) != 1:
        return False
    node = body[0]
    is_call = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    return is_call or isinstance(node, CODE)


def problem(line: str, suffix: str) -> str | None:
    """What is wrong with one line of a file of this kind, or None."""
    if UNFINISHED.search(line) and not ISSUE.search(line):
        return "unfinished work needs an issue number (#12)"
    if MACHINE_PATH.search(line):
        return "a path of one machine"
    if suffix in {".hpp", ".cpp"} and CPP_CODE.match(line) and not CPP_PROSE.match(line):
        return "looks like commented-out code"
    comment = PYTHON_COMMENT.match(line) if suffix == ".py" else None
    if comment and is_python_code(comment[1]):
        return "looks like commented-out code"
    return None


def check(root: Path, files: list[Path]) -> list[str]:
    """Every finding in `files` (relative to root), as 'file:line: why: text'."""
    found = []
    for file in files:
        if file.suffix not in TEXT:
            continue
        for number, line in enumerate((root / file).read_text(errors="replace").splitlines(), 1):
            why = problem(line, file.suffix)
            if why:
                found.append(f"{file}:{number}: {why}: {line.strip()[:100]}")
    return found


if __name__ == "__main__":
    top = Path(__file__).resolve().parents[1]
    findings = check(top, project_files(top))
    print(*findings, f"{len(findings)} lines to mend", sep="\n")
    sys.exit(bool(findings))
