# SPDX-License-Identifier: BSD-3-Clause
"""The files of the working tree that git tracks or would track."""

import subprocess
from pathlib import Path


def project_files(root: Path) -> list[Path]:
    """Tracked and not ignored files under root, relative to it, sorted."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=root,
        check=True,
        capture_output=True,
        text=True,
    ).stdout.split("\0")
    return sorted(Path(name) for name in listed if name and (root / name).is_file())
