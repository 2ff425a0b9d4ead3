# SPDX-License-Identifier: BSD-3-Clause
"""`python -m mpm3dpp` is the command `mpm3dpp`."""

from mpm3dpp.cli.command import main

main()
