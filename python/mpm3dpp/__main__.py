# SPDX-License-Identifier: BSD-3-Clause
"""`python -m mpm3dpp` is the command `mpm3dpp`."""

from .cli import main

main()
