# SPDX-License-Identifier: BSD-3-Clause
"""Classes stay small: at most 20 member functions, in a header and one source file.

Reads C++ by braces and parentheses, which is enough for this code; tests are not looked at.
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

from files import project_files

MEMBERS, SOURCES = 20, 1
NOISE = re.compile(r'//[^\n]*|"(?:\\.|[^"\\\n])*"')
HEAD = re.compile(r"\b(?:class|struct)\s+(\w+)[^;{()]*\{")
OUTSIDE = re.compile(r"^[^\s=;][^=;\n]*?\b(\w+)(?:<[^<>]*>)?::~?\w+\(", re.MULTILINE)
NO_MEMBER = re.compile(r"=\s*delete|static_assert|\bfriend\b|\busing\b|=\s*[\w:<>]+\(\)")
FUNCTION = re.compile(r"[\w\])>+\-*/!<=&|~]\s*\(\)")


def own_text(text: str, begin: int) -> str:
    """What stands in a class whose brace opens before `begin`, without bodies and arguments."""
    braces, parentheses, kept = 1, 0, []
    for char in text[begin:]:
        braces += (char == "{") - (char == "}")
        if braces == 0:
            break
        if braces > 1:
            continue
        if char == "}":
            kept.append(";")  # A body has ended.
        elif char == "(":
            kept.append("()" if parentheses == 0 else "")
            parentheses += 1
        elif char == ")":
            parentheses -= 1
        elif parentheses == 0:
            kept.append(char)
    return "".join(kept)


def members(text: str, begin: int) -> int:
    """How many member functions a class declares; overloads count each."""
    parts = own_text(text, begin).split(";")
    return sum(1 for part in parts if FUNCTION.search(part) and not NO_MEMBER.search(part))


def check(root: Path, files: list[Path]) -> list[str]:
    """A sentence for each class that is too large, paths relative to root."""
    found, sources = [], defaultdict(set)
    for file in files:
        if file.suffix not in {".hpp", ".cpp"} or file.parts[0] == "tests":
            continue
        text = NOISE.sub("", (root / file).read_text())
        for head in HEAD.finditer(text):
            if (number := members(text, head.end())) > MEMBERS:
                found.append(f"{file}: {head[1]} has {number} member functions: split it")
        for outside in OUTSIDE.finditer(text) if file.suffix == ".cpp" else ():
            sources[outside[1]].add(str(file))
    for name, places in sources.items():
        if len(places) > SOURCES:
            found.append(f"{name} has member functions in {', '.join(sorted(places))}: split it")
    return found


if __name__ == "__main__":
    top = Path(__file__).resolve().parents[1]
    large = check(top, project_files(top))
    print(*large, f"{len(large)} classes too large", sep="\n")
    sys.exit(bool(large))
