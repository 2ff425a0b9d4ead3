# SPDX-License-Identifier: BSD-3-Clause
"""`python -m mpm3dpp` is the command `mpm3dpp`."""

from mpm3dpp.base.start import forget_folder

forget_folder()  # Python has put it before all others.

from mpm3dpp.cli.command import main  # noqa: E402

main()
