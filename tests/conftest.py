# SPDX-License-Identifier: BSD-3-Clause
"""Tests run beside each other, a file on each core: a thread where nobody says how many."""

import os

import pytest

os.environ.setdefault("OMP_NUM_THREADS", "1")

LONG = ("test_mpi", "test_mpi_frames", "test_verification", "test_core_units", "test_relations",
        "test_checkpoint", "test_plots", "test_study", "test_run", "test_probes")  # fmt: skip
"""Files that take longest, begun first: else one worker is left with one of them."""


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int | None:
    """More workers than cores: some tests wait for processes or for the clock."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return None if cores is None else cores + cores // 2


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the long files first; tests of a file keep their order."""
    rank = {name: k for k, name in enumerate(LONG)}
    items.sort(key=lambda item: rank.get(item.path.stem, len(rank)))
