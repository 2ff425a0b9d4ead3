# SPDX-License-Identifier: BSD-3-Clause
"""Tests run beside each other, a file on each core: a thread where nobody says how many."""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
