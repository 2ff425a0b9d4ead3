# SPDX-License-Identifier: BSD-3-Clause
"""A run of several ranks of which one meets a full disk.

    mpiexec -n N python full_disk.py RANK FRAME WORDS...

The command's WORDS; RANK cannot write its part of FRAME.
"""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path
from typing import Any

from mpm3dpp.base.disk import writing
from mpm3dpp.cli.command import main
from mpm3dpp.io import frames_writer
from mpm3dpp.ranks.world import world

who, frame = (int(word) for word in sys.argv[1:3])
sys.argv[1:] = sys.argv[3:]
ranks = world()
assert ranks is not None
if ranks.rank == who:
    write = frames_writer.write_frame

    def write_until(path: Path, *about: Any) -> None:
        if int(path.name.partition(".")[0]) == frame:
            with writing(path):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        write(path, *about)

    frames_writer.write_frame = write_until
main()
