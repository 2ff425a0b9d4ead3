# SPDX-License-Identifier: BSD-3-Clause
"""A case as a simulation that is ready to step."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, RunError, nearest
from mpm3dpp.base.machine import thread_count
from mpm3dpp.base.ours import refuse_others
from mpm3dpp.case.case import Case
from mpm3dpp.case.choose_frames import all_in_space
from mpm3dpp.fill.advisories import notes, with_overlap
from mpm3dpp.fill.build import build, warnings
from mpm3dpp.fill.point_warnings import point_warnings
from mpm3dpp.io.checkpoint import read_about, restore_checkpoint, write_checkpoint
from mpm3dpp.ranks.world import World

from .add_part import add_actions
from .body_numbers import number_of, numbers_of
from .checkpoints import check_same
from .device import CPU, CUDA, check_device, take_device
from .fill_core import fill_core, new_core, prepare_core


class Simulation:
    """A case filled with particles and ready to step.

    Args:
        case: what to simulate.
        threads: how many; by default OMP_NUM_THREADS, else all cores.
        fused: whether neighbouring stages of a step are done at once, which is faster and gives the
            same bits; False makes them one by one, as the scheme lists them.
        disorder: share of a body's particles that changes cell before its columns in memory are
            put back in order, which costs or saves time and moves no bit; by default what pays.
        imbalance_limit: cost of a rank over the mean one above which ranks share out the grid anew,
            which moves no bit; by default 1.05, infinite for never.
        ranks: parts of the grid, each worked on by a thread of its own as by a process, with what
            processes tell each other; to test that their number moves no bit.
        forced: names of bodies and grains to whose particles the program will give forces,
            `set_body_force`.
        world: processes that work on it, `mpm3dpp.ranks.world.world()`; each calls the same
            functions. Columns and records are those of all in the first of them.
        device: who makes the steps: "cpu"; "cuda", a GPU, with the same bits; "auto", it if it can,
            else the processor.

    Attributes:
        case: as given.
        bodies: the bodies' names, in the order of their numbers; those of grains come last.
        parts: of each body, the name of its entry in the case: its own, or that of its grains.
        warnings, notes: sentences about the case, for the user.
        presses: whether bodies are pressed into each other while it settles.
        is_recorded: whether a run is being written, which takes the history.
        device: who makes the steps, `mpm3dpp.run.device.Device`.
        device_seconds: that a device has taken for steps [s].
        core: the compiled simulation (`mpm3dpp._core.Simulation`).

    Raises:
        CaseError: the case cannot be filled, or the core refuses a parameter, or an argument is
            wrong, or there is no such device, or none that knows all that the case has.
    """

    def __init__(
        self,
        case: Case,
        threads: int | None = None,
        fused: bool = True,
        disorder: float | None = None,
        imbalance_limit: float | None = None,
        ranks: int = 1,
        world: World | None = None,
        forced: Sequence[str] = (),
        device: str = CPU,
    ) -> None:
        if not isinstance(case, Case):
            remedy = 'give what mpm3dpp.load_case("case.toml") returns, or make a Case'
            raise CaseError("must be a Case", remedy, key="case", value=case)
        self._wanted = check_device(device, alone=world is None)
        if self._wanted == CUDA:
            case = all_in_space(case, "a device makes the steps")
        filled = build(case, world)
        self.case, self._world = case, world
        cores = world.cores_of_rank() if world else None
        self.threads = thread_count(threads, cores)
        parts = filled.parts.values()
        self.bodies = [name for part in parts for name in part.names]
        self.parts = [part.name for part in parts for _ in part.names]
        self.materials = [part.material for part in parts for _ in part.names]
        self.warnings = [*warnings(filled), *point_warnings(case, filled)]
        self.notes = notes(case, filled, world)
        self.core = new_core(case, self.threads, fused, disorder, imbalance_limit, ranks, world)
        masses = fill_core(self.core, case, filled, world)
        self.is_recorded = False
        self._forced = set(arguments.texts("forced", forced))
        add_actions(self.core, case, self._numbers, masses, forced)
        drawn = filled.interferences
        self.presses = any(one.pressed for one in drawn)
        prepare_core(self.core, case, self.bodies, drawn)
        self.notes = with_overlap(self.notes, case, self.core.contact_summary(), drawn)
        self.device_seconds = 0.0
        self.take_device()

    def take_device(self) -> None:
        """Let the device that was asked for make the steps, also once a state has been restored.

        Raises:
            CaseError: it cannot.
        """
        self.device = take_device(self.core, self._wanted, alone=self._world is None)

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self.core.time

    @property
    def dt(self) -> float:
        """Length of the next step [s]; the last ones before an end time are shorter."""
        return self.core.dt

    @property
    def step(self) -> int:
        """Steps made."""
        return self.core.step

    def advance(self, steps: int, end_time: float | None = None) -> int:
        """Make up to `steps` steps, to `end_time` [s] at most (the case's by default).

        Ctrl-C and SIGTERM act at the end of the step that is being made, as the program has them
        act: by default Ctrl-C raises KeyboardInterrupt. If they raise nothing, the steps are not
        made to the end either, so that the program can see what they have left.

        Returns:
            The number of steps made: fewer at the end time, and after a signal.

        Raises:
            CaseError: `steps` is no whole number >= 0, or `end_time` no time, which is finite.
            RunError: the run has become unstable: who, where, when and why.
            RuntimeError: another thread is at work in this simulation, or the device has failed.
        """
        made = 0
        steps = arguments.whole_number("steps", steps, 0)
        end = self.case.run.end_time
        if end_time is not None:
            end = arguments.quantity("end_time", end_time, "s")
        while made < steps:
            wanted = min(steps - made, self.core.history_capacity)
            begin = clock.perf_counter()
            done = self.core.advance(wanted, end)
            if self.device.name != CPU:
                self.device_seconds += clock.perf_counter() - begin
            made += done
            if self.core.failure is not None:
                raise RunError(self.core.failure.message)
            if done < wanted:
                break
        return made

    def column(self, body: str, name: str) -> np.ndarray:
        """Return a column of a body, shape (n, components), particles in the order of filling.

        Args:
            body: its name; that of an entry of `grains` stands for all of them, one by one.
            name: "position" [m], "velocity" [m/s], "stress" [Pa] (xx yy zz yz xz xy, tension
                positive), "volume" [m^3], "mass" [kg], or a state column of its material.

        Raises:
            CaseError: there is no such body or column.
        """
        numbers = self._numbers(body)
        known = [column.name for column in self.core.columns(numbers[0])]
        if arguments.text("name", name) not in known:
            raise CaseError(f"is not a column of {body}", nearest(name, known), value=name)
        return np.concatenate([self.core.column(number, name) for number in numbers])

    def ranks_of(self, body: str) -> np.ndarray:
        """Return the number of the rank that has each particle of a body, shape (n,).

        Of several ranks the first has the rows, others none.

        Raises:
            CaseError: there is no such body.
        """
        found = [self.core.ranks_of(number) for number in self._numbers(body)]
        return np.concatenate(found)[:, 0].astype(int)

    def eroded(self) -> dict[str, Any]:
        """Return `mass` [kg] (per metre in 2D) and `count` of the particles that have eroded.

        They stay in the columns as they were when they left, with `failed` = 3.
        """
        return dict(self.core.eroded())

    def left(self) -> dict[str, Any]:
        """Return `mass` [kg] (per metre in 2D) and `count` of particles out of `grid.outflow_box`.

        They stay in the columns as they were when they left, with `failed` = 4.
        """
        return dict(self.core.left())

    def set_velocity(self, body: str, velocities: np.ndarray) -> None:
        """Give the particles of a body velocities [m/s], shape (n, D), in the order of filling.

        Raises:
            CaseError: there is no such body, its motion is prescribed, or `velocities` do not fit.
        """
        if (
            arguments.text("body", body) in self.case.body
            and self.case.body[body].motion is not None
        ):
            raise CaseError("has a prescribed motion", "remove motion from it", value=body)
        number = number_of(body, self.bodies)
        self.core.set_velocity(number, self._vectors("velocities", velocities, number))

    def set_body_force(self, body: str, forces: np.ndarray) -> None:
        """Give the particles of a body a force per mass [m/s^2], from the next step on.

        It stays until another is given, and is zero at first. The body is one of those that
        `Simulation(case, forced=["ball"])` names. Its work is in the column `external`.

        Args:
            body: its name.
            forces: shape (n, D), in the order of filling.

        Raises:
            CaseError: there is no such body, it is not forced, or `forces` do not fit.
        """
        number = number_of(body, self.bodies)
        if self._forced.isdisjoint([body, self.parts[number]]):
            remedy = f'make it with Simulation(case, forced=["{body}"])'
            raise CaseError("takes no force from the program", remedy, value=body)
        self.core.set_body_force(number, self._vectors("forces", forces, number))

    def history(self) -> dict[str, np.ndarray]:
        """Return what the history has of the steps made since this was last called.

        Returns:
            The first columns of `history.csv` by name, shape (steps,): step, time, dt, energies and
            so on; of the last 4,096 steps at most.

        Raises:
            CaseError: the run is written (`record`, `run_case`), which takes them.
        """
        if self.is_recorded:
            rule = "has no history while the run is written"
            raise CaseError(rule, "read history.csv afterwards", key="simulation")
        rows = self.core.history()
        return {name: rows[:, k].copy() for k, name in enumerate(self.core.history_columns)}

    def save(self, path: str | Path) -> None:
        """Write the state to a file, in one step; `restore` goes on from it.

        Raises:
            CaseError: it cannot be written, there is a file that holds no state, or the run has
                become unstable.
        """
        if self.core.failure is not None:
            raise CaseError("a run that had to stop cannot be saved", "save it while it goes on")
        if self._world is not None and self._world.rank > 0:
            self.core.save(len)  # The first process writes.
            return
        path = arguments.path("path", path)
        refuse_others(path, b"PK", mark="about.json")
        write_checkpoint(path, self.core, {"case": self.case.content()})

    def restore(self, path: str | Path) -> None:
        """Bring a simulation that has made no step to the state in a file, of `save` or of a run.

        It goes on with the same bits, also with another number of threads. What `core.set_gravity`
        has changed is not in the state.

        Raises:
            CaseError: there is no such file, or it is that of another case or version.
        """
        if self.step > 0:
            raise CaseError("a simulation that has made steps cannot be restored", "make a new one")
        path = arguments.path("path", path)
        try:
            before = read_about(path).get("case")
            check_same(path, before if isinstance(before, dict) else {}, self.case)
            restore_checkpoint(path, self.core)
            self.take_device()
        except CaseError as error:
            remedy = "give a state that was saved with this case"
            raise CaseError(error.rule, remedy, key=error.key, value=error.value) from error

    def _vectors(self, key: str, values: Any, number: int) -> np.ndarray:
        shape = self.core.body_particle_count(number), self.case.grid.dimension
        return arguments.finite_numbers(key, values, shape, "a row for each particle")

    def _numbers(self, body: str) -> list[int]:
        """Return the numbers of the bodies that a name stands for."""
        return numbers_of(body, self.bodies, self.case)
