# SPDX-License-Identifier: BSD-3-Clause
"""`python -m mpm3dpp` is the command `mpm3dpp`."""

from .command import main

main()
