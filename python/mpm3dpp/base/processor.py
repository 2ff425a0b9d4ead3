# SPDX-License-Identifier: BSD-3-Clause
"""Which build of the core this processor can run, in a package that holds several.

A package built on the machine it runs on has one, `_core`. One that runs elsewhere has a build for
three of the levels of x86-64 (System V ABI, AMD64 supplement, section 3.1.1), `_core_x86_64`,
`_core_x86_64_v3` and `_core_x86_64_v4`, and `import mpm3dpp._core` finds the fastest that the
processor knows. The environment variable MPM3DPP_ISA asks for a lower one.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
from collections.abc import Collection, Sequence
from pathlib import Path
from types import ModuleType

from .errors import CaseError, nearest

# Level -> flags of /proc/cpuinfo that it needs, the fastest first.
_V3 = frozenset(["avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe", "xsave"])
LEVELS: dict[str, frozenset[str]] = {
    "x86-64-v4": _V3 | frozenset(["avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"]),
    "x86-64-v3": _V3,
    "x86-64": frozenset(),
}
WISH = "MPM3DPP_ISA"


def processor_flags() -> frozenset[str]:
    """Return the instruction sets of this processor as Linux names them; elsewhere none."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return frozenset()
    flags = next((line.partition(":")[2] for line in lines if line.startswith("flags")), "")
    return frozenset(flags.split())


def choose(present: Sequence[str], flags: Collection[str], wish: str | None = None) -> str:
    """Return the level to use.

    Args:
        present: levels that the package holds, at least one.
        flags: of the processor.
        wish: the level that the user asks for, if any.

    Raises:
        CaseError: the wish is no level of the package, or the processor cannot run it, or none.
    """
    usable = [level for level in LEVELS if level in present and LEVELS[level] <= set(flags)]
    if not usable:
        raise CaseError(
            "this processor cannot run any core of this package",
            "install it from source: pip install --no-binary mpm3dpp mpm3dpp",
        )
    if wish:
        if wish not in present:
            raise CaseError("is not in this build", nearest(wish, present), key=WISH, value=wish)
        if wish not in usable:
            raise CaseError(
                "is more than this processor can do",
                f"unset it, or choose from {', '.join(usable)}",
                key=WISH,
                value=wish,
            )
        return wish
    return usable[0]


class CoreFinder:
    """Finds `mpm3dpp._core` in a package that has several; looks before all other finders."""

    @staticmethod
    def find_spec(
        name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Return where the module is, or None if it is not this finder's.

        Args:
            name: of the module.
            path: the folders of the package.
            target: not used; see `importlib.abc.MetaPathFinder`.
        """
        if name != "mpm3dpp._core":
            return None
        files: dict[str, Path] = {}
        for folder in path or ():
            for level in LEVELS:
                for suffix in importlib.machinery.EXTENSION_SUFFIXES:
                    file = Path(folder) / f"_core_{level.replace('-', '_')}{suffix}"
                    if file.is_file():
                        files.setdefault(level, file)
        wish = os.environ.get(WISH)
        if not files:
            if wish:
                raise CaseError(
                    "is not in this build, which has one core for the processor it was built on",
                    "unset it, or build with MPM_NATIVE=OFF",
                    key=WISH,
                    value=wish,
                )
            return None
        level = choose(list(files), processor_flags(), wish)
        return importlib.util.spec_from_file_location(name, files[level])
