# SPDX-License-Identifier: BSD-3-Clause
"""The code for a device compiles, with warnings as errors, and spills no more than is known.

    python tools/check_device.py          what CI compiles: all but most strength models, and these
                                          without their kernels (tests/cuda/models.cu)
    python tools/check_device.py --all    all, some ten minutes on two processors

It needs nvcc and no card. A kernel spills where it has more numbers than registers; they go to the
device's memory then.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parents[1]
CODE = ROOT / "cpp/mpm/device/cuda"
OUT = ROOT / "build/device-check"
FLAGS = ["-std=c++20", "-arch=sm_90", "-O3", "--expt-relaxed-constexpr", "-fmad=false",
         "-diag-suppress=177", "-Werror", "all-warnings", "-Werror", "cross-execution-space-call",
         "-Xptxas", "-v", f"-I{ROOT / 'cpp'}", "-c"]  # fmt: skip
STRENGTHS = range(11)  # Places in StrengthModels, but for the last, which does not deform.
JOHNSON_COOK = 4
# Kernels that may spill: a part of their name, the most bytes, and why.
MAY_SPILL = (
    ("map_patches", 130, "outside the loop over particles; more blocks at once are faster"),
    ("advance_patches", 110, "likewise"),
    ("sum_nodes", 190, "sums of the walls, which most node tiles do not touch"),
    ("stress_patches<mpm::Elastic, mpm::NoEos, mpm::NoFailures", 150, "the gradient of any basis; "
     "an affine part that closes, which is seldom"),
    ("stress_patches", 800, "laws with state and equation of state have more numbers "
     "than a thread has registers; with fewer threads at once they are slower"),
)  # fmt: skip
PROPERTIES = re.compile(
    r"Compiling entry function '(\S+)' for.*?(\d+) bytes spill stores", re.DOTALL
)


def find_nvcc() -> str | None:
    """Return the compiler's path, None if there is none."""
    usual = "/usr/local/cuda/bin/nvcc"
    return shutil.which("nvcc") or (usual if Path(usual).exists() else None)


def compile_one(nvcc: str, source: Path, defines: list[str]) -> tuple[str, list[str]]:
    """Compile a file; return what is wrong with it."""
    name = "_".join([source.stem, *(d.split("=")[1] for d in defines)])
    command = [nvcc, *FLAGS, *(f"-D{d}" for d in defines), str(source), "-o", f"{OUT / name}.o"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return name, [done.stdout + done.stderr]
    wrong = []
    for mangled, stores in PROPERTIES.findall(done.stderr):
        if int(stores) == 0:
            continue
        kernel = subprocess.run(
            ["c++filt", mangled], capture_output=True, text=True, check=True
        ).stdout.strip()
        most = next((b for part, b, _ in MAY_SPILL if part in kernel), 0)
        if int(stores) > most:
            wrong.append(f"{kernel} spills {stores} bytes, more than {most} (MAY_SPILL)")
    return name, wrong


def main() -> int:
    """Compile, and say what is wrong."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--all", action="store_true", help="the kernels of all strength models")
    everything = parser.parse_args().all
    nvcc = find_nvcc()
    if nvcc is None:
        print("SKIPPED: there is no nvcc, so nothing was compiled for a device")
        return 0
    OUT.mkdir(parents=True, exist_ok=True)
    jobs: list[tuple[Path, list[str]]] = [(ROOT / "tests/cuda/models.cu", [])]
    for k in STRENGTHS if everything else [0]:
        blocks = ["MPM_STRESS_BLOCKS=3"] if k == JOHNSON_COOK else []
        jobs.append((CODE / "stress.cu", [f"MPM_STRENGTH={k}", *blocks]))
    jobs += [(CODE / name, []) for name in ("run.cu", "make_step.cu", "lists.cu", "interface.cu")]
    problems = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for name, wrong in pool.map(lambda job: compile_one(nvcc, *job), jobs):
            problems += len(wrong)
            for text in wrong:
                print(f"{name}: {text}")
    print(f"{len(jobs)} files compiled for a device, {problems} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
