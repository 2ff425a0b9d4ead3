# SPDX-License-Identifier: BSD-3-Clause
"""Restores damaged states, each in a fork of this process, and steps those that are taken.

    python restore.py CASE CHECKPOINT COUNT

changes the bytes of the state in COUNT ways, chosen by a fixed seed, makes the check sums right
again, and prints a JSON object: how often what came of it, and what must not have.
"""

from __future__ import annotations

import collections
import json
import os
import random
import resource
import signal
import struct
import sys
import traceback
import zipfile
from pathlib import Path

from mpm3dpp import Simulation, load_case
from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.io.checkpoint import restore_checkpoint

SEED, STEPS, LONGEST, MEMORY = 2026, 30, 60, 8 << 30
REFUSED, STOPPED, STEPPED, TRACEBACK = 0, 1, 2, 3
NAMES = {0: "refused", 1: "run stopped with a sentence", 2: "stepped"}
INTEGERS = [0, 1, 2, 255, 1 << 16, (1 << 31) - 1, 1 << 31, (1 << 32) - 1, 1 << 40, (1 << 63) - 1]
NUMBERS = [0.0, -0.0, -1.0, 1e-300, 1e30, 1e300, -1e300, float("inf"), float("nan")]


def main(case_file: str, checkpoint: str, count: str) -> None:
    case, path = load_case(case_file), Path(checkpoint)
    simulation = Simulation(case, threads=1)
    with zipfile.ZipFile(path) as archive:
        about, state = archive.read("about.json"), archive.read("state")
    chance = random.Random(SEED)
    outcomes: collections.Counter[str] = collections.Counter()
    wrong = []
    for k in range(int(count)):
        changed, what = damaged(state, chance)
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("about.json", about)
            archive.writestr("state", changed)
        code, said = fork(simulation, path)
        if code in NAMES and "\n" not in said:
            outcomes[NAMES[code]] += 1
        else:
            wrong.append([k, what, code, said])
    print(json.dumps({"outcomes": outcomes, "wrong": wrong}))


def damaged(state: bytes, chance: random.Random) -> tuple[bytes, str]:
    """Return other bytes, of the same number or not, and what has been done."""
    kind = chance.choice(["bit", "byte", "integer", "integer", "number", "cut", "swap", "more"])
    at = chance.randrange(len(state) - 8)
    # Much of a state is columns of particles; its head and its lists are where structure is.
    if chance.random() < 0.5:
        at = chance.choice(
            [chance.randrange(200), len(state) - 9 - chance.randrange(len(state) // 2)]
        )
    changed = bytearray(state)
    if kind == "bit":
        changed[at] ^= 1 << chance.randrange(8)
    elif kind == "byte":
        changed[at] = chance.randrange(256)
    elif kind == "integer":
        size = chance.choice([4, 8])
        changed[at : at + size] = (chance.choice(INTEGERS) % (1 << 8 * size)).to_bytes(
            size, "little"
        )
    elif kind == "number":
        changed[at : at + 8] = struct.pack("<d", chance.choice(NUMBERS))
    elif kind == "cut":
        del changed[at:]
    elif kind == "swap":
        other = chance.randrange(len(state) - 8)
        changed[at : at + 8], changed[other : other + 8] = (
            changed[other : other + 8],
            changed[at : at + 8],
        )
    else:
        changed += bytes(chance.randrange(1, 100))
    return bytes(changed), f"{kind} at {at} of {len(state)}"


def fork(simulation: Simulation, path: Path) -> tuple[int, str]:
    """Restore in a fork, and step; return how it ended, and what it said."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(LONGEST)
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        code, said = STEPPED, ""
        try:
            restore_checkpoint(path, simulation.core)
            simulation.advance(STEPS)
        except CaseError as error:
            code, said = REFUSED, str(error)
        except RunError as error:
            code, said = STOPPED, str(error)
        except BaseException:
            code, said = TRACEBACK, traceback.format_exc()
        os.write(writing, said.encode()[:60000])
        os._exit(code)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8") as pipe:
        said = pipe.read()
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), said


if __name__ == "__main__":
    main(*sys.argv[1:])
