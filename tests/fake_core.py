# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for the core's `Simulation`: two blocks that meet, with made-up stresses."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from mpm3dpp import _core

COLUMNS = (
    *("step", "time", "dt", "kinetic", "internal", "plastic", "viscous", "friction"),
    *("restitution", "contact", "springs", "external", "absorbed", "damped"),
    *("eroded", "fracture", "left", "bounded"),
    *("numerical", "residual"),
    *("momentum_x", "momentum_y", "momentum_z"),
    *("numerical_mapping", "numerical_time"),
)
SPEED, STEP, SIZE = 10.0, 1e-5, 1e-3


def pressure(stress: np.ndarray) -> np.ndarray:
    """Mean compressive stress -(xx + yy + zz)/3, of (n, 6) in the order xx yy zz yz xz xy."""
    return -(stress[:, 0] + stress[:, 1] + stress[:, 2]) / 3.0


def von_mises(stress: np.ndarray) -> np.ndarray:
    """Equivalent stress sqrt(3/2 s:s), s the deviator, of (n, 6) (von Mises, 1913)."""
    xx, yy, zz, yz, xz, xy = stress.T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    shear = yz**2 + xz**2 + xy**2
    return np.sqrt(0.5 * normal + 3.0 * shear)


class FakeSimulation:
    """Two square (or cubic) blocks of 8 particles a side; only the second has `damage`."""

    def __init__(self, dimension: int = 2, gap: float = 2e-3) -> None:
        self.dimension = dimension
        axis = (np.arange(8) + 0.5) * SIZE
        block = np.stack(np.meshgrid(*[axis] * dimension, indexing="ij"), -1)
        block = block.reshape(-1, dimension)
        shift = np.eye(dimension)[0] * (8 * SIZE + gap)
        self._start = [block, block + shift]
        self._first = gap / (2 * SPEED)
        self.step, self.time, self.dt = 0, 0.0, STEP
        self.body_count, self.particle_count = 2, 2 * len(block)
        self.total_mass = 1000.0 * self.particle_count * SIZE**dimension
        self.history_columns = list(COLUMNS)
        self._rows: list[list[float]] = []

    def grains_and_contacts(self) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros((2, len(_core.grain_columns))), np.zeros((0, len(_core.contact_columns)))

    def advance(self, steps: int) -> None:
        for _ in range(steps):
            self.step += 1
            self.time += self.dt
            touching = float(self.time >= self._first)
            kinetic = 4.0 - touching
            momentum = [0.0, 0.0, 0.0]
            ledger = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1e-3, 1e-16, *momentum, -6e-4, -4e-4]
            self._rows.append([self.step, self.time, self.dt, kinetic, touching, *ledger])

    def history(self) -> np.ndarray:
        rows, self._rows = np.array(self._rows), []
        return rows

    def body_particle_count(self, body: int) -> int:
        return len(self._start[body])

    def columns(self, body: int) -> list[Any]:
        names = [("position", self.dimension, "m"), ("velocity", self.dimension, "m/s")]
        names += [("stress", 6, "Pa"), ("volume", 1, "m^3"), ("mass", 1, "kg")]
        if body == 1:
            names.append(("damage", 1, ""))
        return [SimpleNamespace(name=n, components=c, unit=u) for n, c, u in names]

    def column(self, body: int, name: str) -> np.ndarray:
        start = self._start[body]
        count = len(start)
        sign = 1.0 - 2.0 * body
        moved = np.eye(self.dimension)[0] * sign * SPEED
        rows = np.arange(count)[:, None]
        return {
            "position": start + moved * min(self.time, self._first),
            "velocity": np.tile(moved, (count, 1)),
            "stress": 1e6 * (rows + 1) * np.arange(1.0, 7.0) * (1 + self.step),
            "volume": np.full((count, 1), SIZE**self.dimension),
            "mass": np.full((count, 1), 1000.0 * SIZE**self.dimension),
            "damage": rows / count,
        }[name]

    def rounded_column(
        self,
        name: str,
        places: list[int],
        width: int,
        elsewhere: float,
        writers: Sequence[int] = (0,),
    ) -> np.ndarray:
        """As the core: the columns of all bodies, component c at places[c]."""
        assert list(writers) == [0]
        rounded = np.full((self.particle_count, width), elsewhere, dtype=np.float32)
        end = 0
        for body in range(self.body_count):
            count = self.body_particle_count(body)
            if name in [column.name for column in self.columns(body)]:
                rounded[end : end + count, places] = self.column(body, name)
            end += count
        return rounded

    def rounded_derived(self, name: str, writers: Sequence[int] = (0,)) -> np.ndarray:
        assert list(writers) == [0]
        if name == "size":
            return np.full((self.particle_count, 1), SIZE, dtype=np.float32)
        stress = np.concatenate([self.column(b, "stress") for b in range(self.body_count)])
        of_stress = {"pressure": pressure, "von_mises": von_mises}[name]
        return of_stress(stress).astype(np.float32)[:, None]

    def contact_pairs(self) -> list[Any]:
        touching = self.time >= self._first
        pair = SimpleNamespace(
            bodies=(0, 1),
            first_time=self._first if touching else float("nan"),
            first_gap=0.0 if touching else float("nan"),
            first_normal=[1.0 * touching, 0.0, 0.0],
            first_node=[0.0, 0.0, 0.0],
            first_step=10 if touching else -1,
            force=[-5.0 * touching, 0.0, 0.0],
            impulse=[-0.1 * touching, 0.0, 0.0],
            friction_work=0.0,
            pairs=1,
        )
        return [pair]

    contact_groups = contact_pairs

    def contact_summary(self) -> dict[str, int]:
        return {
            "overlapped_nodes": 3,
            "overlapped_nodes_max": 9,
            "bodies_per_node_max": 2,
            "bytes": 640,
        }

    def limiter(self) -> Any:
        return SimpleNamespace(body=1, particle=7, sound_speed=100.0, speed=SPEED)

    def eroded(self) -> dict[str, float]:
        return {"mass": 0.0, "count": 0}

    def left(self) -> dict[str, float]:
        return {"mass": 0.0, "count": 0}

    def loads(self) -> list[Any]:
        return []

    def walls(self) -> list[Any]:
        return []

    def warnings(self) -> list[Any]:
        return []

    def ranks(self) -> dict[str, float]:
        told = dict.fromkeys(("letters", "bytes", "exchanges", "reductions", "share"), 0.0)
        return {"ranks": 1, "imbalance": 1.0, **told}

    def timers(self) -> dict[str, float]:
        return {"map momentum": 2e-3, "advance particles": 1e-3}

    def bytes(self) -> dict[str, int]:
        return {"particles": 1000, "grid": 200, "contact": 64, "other": 10}
