# SPDX-License-Identifier: BSD-3-Clause
"""Which MPI mpi4py uses, on standard output; `launch.py` asks, for the answer begins MPI."""

from __future__ import annotations

if __name__ == "__main__":
    from mpi4py import MPI

    print(MPI.Get_library_version())
