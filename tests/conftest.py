# SPDX-License-Identifier: BSD-3-Clause
"""Tests run beside each other, a file on each core: a thread where nobody says how many."""

from __future__ import annotations

import os

import pytest

os.environ.setdefault("OMP_NUM_THREADS", "1")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Return how many files `-n auto` runs at once: one more than there are processors.

    Tests of ranks, kills and full disks wait a good part of their time.
    """
    return (os.cpu_count() or 1) + 1
