# SPDX-License-Identifier: BSD-3-Clause
"""The statements about what sets bodies going, pushes and damps them: velo, load, QuLo, Damp."""

from __future__ import annotations

from .deck import Deck, Wave
from .lexer import Reader

# Initial velocities that cannot be honoured: what they are, and the numbers that follow.
_VELOCITIES = {
    "node": ("velocities of single particles", ("its particle", "vx", "vy", "vz")),
    "ksin": ("this velocity field", ("v0", "its body")),
    "nuli": ("this velocity field", ("its amplitude",)),
}


def load(reader: Reader, deck: Deck) -> None:
    """Read loads until `endl`."""
    while True:
        word = reader.word("endl")
        line = reader.line
        if word.key == "endl":
            return
        if word.key == "grav":
            body = _body(reader, deck)
            deck.gravity[body] = (reader.numbers("gx", "gy", "gz"), line)
        elif word.key == "body":
            body = _body(reader, deck)
            deck.force[body] = (reader.numbers("fx", "fy", "fz"), line)
        elif word.key == "part":
            number = reader.integer("the number of a particle")
            deck.particle_force[number] = (reader.numbers("fx", "fy", "fz"), line)
        elif word.key == "node":
            while reader.number_follows():
                reader.number("a force")
            rule = f'has "{word.text}": at this load MPM3D-F90 itself stops'
            deck.refuse(reader.keyword, rule, "it is called part now", line)
        else:
            rule = f'has the unknown load "{word.text}"'
            raise reader.error(rule, "the loads are grav, body and part; endl ends them")


def velocity(reader: Reader, deck: Deck) -> None:
    """Read initial velocities until `endv`; those of single particles cannot be honoured."""
    while True:
        word = reader.word("endv")
        line = reader.line
        if word.key == "endv":
            return
        if word.key == "body":
            body = _body(reader, deck)
            deck.velocity[body] = (reader.numbers("vx", "vy", "vz"), line)
        elif word.key == "vsin":
            wave = Wave(reader.number("v0"))
            for body in range(1, len(deck.parts) + 1):
                others = deck.velocity[body][0][1:] if body in deck.velocity else [0.0, 0.0]
                deck.velocity[body] = ([wave, *others], line)
        elif word.key in _VELOCITIES:
            what, numbers = _VELOCITIES[word.key]
            reader.numbers(*numbers)
            rule = f'has "{word.text}": {what} cannot be honoured'
            remedy = "use body, or leave it out and call Simulation.set_velocity in Python"
            deck.refuse(reader.keyword, rule, remedy, line)
        else:
            rule = f'has the unknown velocity "{word.text}"'
            raise reader.error(rule, "the velocities are body, node, vsin; endv ends them")


def damping(reader: Reader, deck: Deck) -> None:
    """Read `Damp a`: a force -a m v on every particle."""
    rate = reader.number("its factor")
    if rate < 0:
        raise reader.error(f"is {rate:g} but must be >= 0", "give a rate, or leave it out")
    deck.damping = rate
    if not rate:
        deck.note("Damp 0 has no effect")


def rise(reader: Reader, deck: Deck) -> None:
    """Read `QuLo T`: forces on particles rise from 0 over a time."""
    time = reader.number("the time in which loads rise")
    if not time > 0:
        raise reader.error(f"is {time:g} but must be > 0", "give a time, or leave it out")
    deck.rise = time
    deck.note(
        "QuLo: the run ends at endt; MPM3D-F90 goes on from there until the kinetic energy is less "
        "than 0.005 of all, and the time more than 100"
    )


def _body(reader: Reader, deck: Deck) -> int:
    number = reader.integer("the number of a body")
    if not 1 <= number <= max(deck.bodies, 1):
        rule = f"names body {number} but nbbo is {deck.bodies}"
        remedy = "bodies are numbered from 1 in the order of the part statements"
        deck.refuse(reader.keyword, rule, remedy, reader.line)
    return number
