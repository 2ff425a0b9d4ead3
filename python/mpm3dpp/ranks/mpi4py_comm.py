# SPDX-License-Identifier: BSD-3-Clause
"""What the core asks of ranks, by mpi4py: where no module was built for the MPI that it uses.

The same as `mpi/mpi_comm.cpp`, whose comments say why.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

_EXPECTED, _UNEXPECTED = 1, 2
_LARGEST, _SMALLEST = np.iinfo(np.int64).max, np.iinfo(np.int64).min

Letters = list[tuple[int, memoryview]]
"""Other ranks, and bytes to or from them."""


class Mpi4pyComm:
    """A communicator of its own for the core.

    Args:
        mpi: the module `mpi4py.MPI`.          users: the communicator of which it is a copy.
        fail: see `World.fail`.
        piece: bytes in which letters of any length go at most.
    """

    def __init__(self, mpi: Any, users: Any, fail: Callable[[str], None], piece: int) -> None:
        self._mpi, self._piece = mpi, piece
        self._comm = users.Dup()
        self._receiving: dict[int, list[tuple[Any, int]]] = {}
        self._sending: dict[int, list[Any]] = {}
        self._round = 0
        self.rank: int = users.rank
        self.size: int = users.size
        self.fail = fail

    def all_max(self, numbers: memoryview) -> None:
        """Replace numbers by the largest of all ranks; what is no number counts as the largest."""
        values = np.frombuffer(numbers, dtype=np.float64)
        bits = values.view(np.int64)
        keys = np.where(bits >= 0, bits, _SMALLEST - bits - 1)
        keys[np.isnan(values)] = _LARGEST
        self._comm.Allreduce(self._mpi.IN_PLACE, keys, op=self._mpi.MAX)
        largest = np.where(keys >= 0, keys, _SMALLEST - keys - 1).view(np.float64)
        values[:] = np.where(keys == _LARGEST, np.nan, largest)

    def all_sum(self, numbers: memoryview) -> None:
        """Replace integers by their sums over all ranks."""
        values = np.frombuffer(numbers, dtype=np.int64)
        self._comm.Allreduce(self._mpi.IN_PLACE, values, op=self._mpi.SUM)

    def start(self, key: int, out: Letters, into: Letters) -> None:
        """Start to send and to receive letters of known lengths."""
        self.release(key)
        self._receiving[key] = [
            (self._comm.Irecv(self._bytes(view), rank, _EXPECTED), len(view)) for rank, view in into
        ]
        self._sending[key] = [
            self._comm.Isend(self._bytes(view), rank, _EXPECTED) for rank, view in out
        ]

    def finish(self, key: int) -> None:
        """Wait until all that was started has been received."""
        expected = self._receiving.pop(key)
        came = [self._mpi.Status() for _ in expected]
        self._mpi.Request.Waitall([request for request, _ in expected], came)
        for (_, length), status in zip(expected, came, strict=True):
            if status.Get_count(self._mpi.BYTE) != length:
                raise RuntimeError("a letter has another length than was agreed")

    def release(self, key: int) -> None:
        """Wait until all that was started has been sent."""
        self._mpi.Request.Waitall(self._sending.pop(key, []))

    def exchange(self, out: Letters) -> list[tuple[int, bytes]]:
        """Send letters to whom nobody knows of; return those that have come, by rank."""
        tag = _UNEXPECTED + self._round % 2
        self._round += 1
        sent = [
            self._comm.Issend(self._bytes(view[at : at + self._piece]), rank, tag)
            for rank, view in out
            for at in range(0, max(1, len(view)), self._piece)
        ]
        got: dict[int, bytearray] = {}  # Pieces of a letter come one behind another.
        status, all_taken = self._mpi.Status(), None
        while True:
            if self._comm.Iprobe(self._mpi.ANY_SOURCE, tag, status):
                piece = bytearray(status.Get_count(self._mpi.BYTE))
                source = status.Get_source()
                self._comm.Recv(self._bytes(piece), source, tag)
                got.setdefault(source, bytearray()).extend(piece)
            if all_taken is not None:
                if all_taken.Test():
                    return sorted((source, bytes(letter)) for source, letter in got.items())
            elif self._mpi.Request.Testall(sent):
                all_taken = self._comm.Ibarrier()

    def _bytes(self, view: memoryview | bytearray) -> list[Any]:
        return [view, len(view), self._mpi.BYTE]
