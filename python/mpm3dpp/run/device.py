# SPDX-License-Identifier: BSD-3-Clause
"""Who makes the steps of a run: the processor, or a device, which is a GPU."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from mpm3dpp import _core
from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, nearest

CPU, CUDA, AUTO = DEVICES = ("cpu", "cuda", "auto")
ONE_PROCESS = "--device cuda makes the steps of one process"


@dataclass(frozen=True)
class Device:
    """Who makes the steps.

    Attributes:
        name: of the device, "cpu" if it is the processor.
        told: a sentence for the user; empty if nobody has asked for a device.
    """

    name: str = CPU
    told: str = ""


def check_device(wanted: str, alone: bool = True) -> str:
    """Return which device is wanted, one of `DEVICES`.

    Args:
        wanted: by the user.
        alone: whether one process makes the run.

    Raises:
        CaseError: it is none of them, or there is none; or there are several processes.
    """
    if arguments.text("device", wanted) not in DEVICES:
        raise CaseError("must be cpu, cuda or auto", nearest(wanted, DEVICES), key="device")
    if wanted == CUDA:
        if not alone:
            raise CaseError(f"{ONE_PROCESS}: leave --ranks out")
        try:
            _core.Simulation.device()
        except RuntimeError as error:
            raise CaseError(str(error)) from None
    return wanted


def take_device(core: Any, wanted: str, alone: bool = True) -> Device:
    """Let the device that is wanted make the steps from now on.

    Args:
        core: the core's `Simulation`, ready to step.
        wanted: as `check_device` returns it; "auto" makes do with the processor.
        alone: whether one process makes the run.

    Raises:
        CaseError: "cuda" is wanted, and there is no device, it has too little memory, or it does
            not know all that the case has.
    """
    if wanted == CPU:
        return Device()
    try:
        if not alone:
            raise ValueError("a device makes the steps of one process")
        about = _core.Simulation.device()
        core.use_device()
    except (RuntimeError, ValueError) as error:
        if wanted == AUTO:
            return Device(CPU, f"device auto: {error}; running on the processor")
        raise CaseError(str(error)) from None
    taken, all_of_it = core.device_bytes / 2**30, about["bytes"] / 2**30
    told = f"device: {about['name']}, {taken:.2f} GiB of its {all_of_it:.1f} GiB of memory taken"
    return Device(about["name"], told)


@contextmanager
def failures_of(device: Device) -> Iterator[None]:
    """Make a `CaseError` of a device's failure, in a step or when its particles are read."""
    try:
        yield
    except RuntimeError as error:
        if device.name == CPU:
            raise
        raise CaseError(str(error)) from error
