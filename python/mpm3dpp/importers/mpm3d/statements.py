# SPDX-License-Identifier: BSD-3-Clause
"""The statements of an `.mpm` file: words to a `Deck`. Only the first four letters of a keyword
count."""

from __future__ import annotations

from collections.abc import Callable

from mpm3dpp.base.errors import CaseError

from . import acting, blocks
from .deck import Deck
from .lexer import Reader, Source

Statement = Callable[[Reader, Deck], None]

# Keywords that change the physics in ways that a case cannot: why, and what to do.
REFUSED = {
    "bimp": ("quadratic B-spline shape functions", "use gimp or the linear basis"),
    "sgmp": ("the staggered-grid method", "leave it out for the standard method"),
    "tlmp": ("the total Lagrangian method", "leave it out for the standard method"),
    "drda": ("kinetic damping", "leave it out"),
}
# Keywords about output that have another counterpart or none.
OUTPUT = {
    "tecp": "TecPlot files are not written; results.vtkhdf opens in ParaView",
    "para": "results.vtkhdf is written in place of the vtu files",
    "smoo": "smooths the pressure of the output only; the pressure written here is the particles'",
}
# Blocks in which keywords have another meaning, and their ends.
BLOCKS = {"load": "endl", "velo": "endv"}


def read_deck(source: Source) -> Deck:
    """Return what a file says; keywords that cannot be honoured are among `source.problems`.

    Raises:
        CaseError: unknown keywords, missing or wrong values; the place is the line.
    """
    reader, deck = Reader(source), Deck(source)
    if not reader.more():
        raise source.error("is empty", "its last word must be endi", 1)
    before, broken = "", False
    while True:
        reader.keyword = ""
        try:
            key = _statement(reader, deck, before)
        except CaseError as error:
            source.problems.keep(error)
            _go_on(reader)
            broken, key = True, ""
            if not reader.more():
                break
        if key == "endi":
            break
        before = key
    if broken:
        source.problems.judge()
    return deck


def _statement(reader: Reader, deck: Deck, before: str) -> str:
    """Read a statement, return its keyword; `before` is that of the last one."""
    word = reader.word("endi")
    key = word.key
    if key == "endi":
        return key
    reader.keyword = word.text
    if key in REFUSED:
        _refuse(reader, deck, key)
        return key
    if key not in STATEMENTS and before == "mate" and word.text.isdigit():
        reader.keyword = "mate"
        rule = f"has material {word.text} but nmat is {deck.material_count}"
        raise reader.error(rule, "correct nmat, or leave the material out")
    if key not in STATEMENTS:
        remedy = "the line above may have a value too many; words after ! are comments"
        raise reader.error("is not a keyword of MPM3D-F90", remedy)
    deck.lines[key] = word.line
    STATEMENTS[key](reader, deck)
    return key


def _refuse(reader: Reader, deck: Deck, key: str) -> None:
    what, remedy = REFUSED[key]
    rule = f"asks for {what}, which cannot be honoured"
    deck.refuse(reader.keyword, rule, remedy, reader.line)


def _go_on(reader: Reader) -> None:
    """After a mistake, go to the next statement that begins a line."""
    end = BLOCKS.get(reader.keyword[:4].lower())
    if end and any(word.key == end for word in reader.source.words[reader.at :]):
        reader.skip_to({end}, first=False)
        reader.word(end)
    else:
        reader.skip_to({*STATEMENTS, *REFUSED, "endi"})


def _title(reader: Reader, deck: Deck) -> None:
    words = reader.source.words
    if reader.more() and words[reader.at].line == reader.line:
        text = "".join(c if c.isprintable() else " " for c in reader.word("a title").text)
        deck.title = " ".join(text.split()).strip("* ")


def _grid(reader: Reader, deck: Deck) -> None:
    for axis in range(3):
        _span(reader, deck, axis)


def _span(reader: Reader, deck: Deck, axis: int) -> None:
    low, high = reader.numbers("the lower bound", "the upper bound")
    if not high > low:
        raise reader.error(f"has bounds {low:g}, {high:g}", "give the lower bound first")
    deck.bounds[axis] = (low, high)


def _cell(reader: Reader, deck: Deck) -> None:
    deck.cell = reader.number("the cell size")
    if deck.cell <= 0:
        raise reader.error(f"is {deck.cell:g} but must be > 0", "give a length")


def _end(reader: Reader, deck: Deck) -> None:
    deck.end = deck.interval = reader.number("the end time")


def _interval(reader: Reader, deck: Deck) -> None:
    deck.interval = reader.number("the interval")
    if deck.interval <= 0:
        raise reader.error(f"is {deck.interval:g} but must be > 0", "give a time")


def _report(reader: Reader, deck: Deck) -> None:
    reader.number("the interval")
    deck.note("rptt has no counterpart: the progress line keeps its own time")


def _faces(reader: Reader, deck: Deck) -> None:
    codes = tuple(reader.integer("a code") for _ in range(6))
    if not set(codes) <= {0, 1, 2}:
        raise reader.error(f"has {codes}", "the codes are 0 free, 1 fixed, 2 symmetry")
    deck.faces = codes


def _jaumann(reader: Reader, deck: Deck) -> None:
    if not reader.switch():
        deck.note("jaum off has no effect, as in MPM3D-F90: stresses always turn with the material")


def _volume(reader: Reader, deck: Deck) -> None:
    deck.note("UVFp is always so here: volumes follow the determinant of the deformation")


def _contact(reader: Reader, deck: Deck) -> None:
    word = reader.word("lagr")
    if word.key not in ("lagr", "othe"):
        raise reader.error(f'has the unknown kind "{word.text}"', "write cont lagr mu ib")
    deck.separate = True
    if word.key == "othe":
        deck.contact = None
        if reader.number_follows():
            reader.numbers("the friction", "whose normal")
        return
    friction, whose = reader.number("the friction"), reader.integer("whose normal")
    if friction < 0 or whose not in (0, 1, 2):
        rule = f"has friction {friction:g} and normal {whose}"
        raise reader.error(rule, "friction must be >= 0, the normal 0, 1 or 2")
    deck.contact = (friction, whose)


def _variable(reader: Reader, deck: Deck) -> None:
    word = reader.word("a variable")
    deck.variables.append((word.text, word.line))


def _curve(reader: Reader, deck: Deck) -> None:
    _variable(reader, deck)
    if reader.number_follows():
        reader.integer("the number of a particle")
    _no_curves(deck)


def _curve_at(reader: Reader, deck: Deck) -> None:
    _variable(reader, deck)
    reader.numbers("x", "y", "z")
    _no_curves(deck)


def _no_curves(deck: Deck) -> None:
    deck.note(
        "curves of single particles (curv, curx) are not written; results.vtkhdf has every "
        "particle in every frame, history.csv the energies of every step"
    )


def _filter(reader: Reader, deck: Deck) -> None:
    reader.numbers("x0", "x1", "y0", "y1", "z0", "z1")
    deck.note("pt2d has no counterpart: all particles are written")


def _points_of_detonation(reader: Reader, deck: Deck) -> None:
    line = reader.line
    deck.detonations.append((reader.numbers("x", "y", "z"), line))


def _count(name: str) -> Statement:
    def read(reader: Reader, deck: Deck) -> None:
        value = reader.integer("a number")
        if value < 1:
            raise reader.error(f"is {value} but must be >= 1", "give a whole number")
        setattr(deck, name, value)

    return read


def _scheme(name: str) -> Statement:
    def read(reader: Reader, deck: Deck) -> None:
        deck.schemes[name] = reader.switch()

    return read


def _factor(reader: Reader, deck: Deck) -> None:
    deck.factor = reader.number("the factor")


def _bulk(reader: Reader, deck: Deck) -> None:
    quadratic, linear = reader.numbers("the quadratic factor", "the linear factor")
    if quadratic < 0 or linear < 0:
        raise reader.error(f"has {quadratic:g}, {linear:g}", "both must be >= 0")
    deck.bulk = (quadratic, linear)


def _gimp(reader: Reader, deck: Deck) -> None:
    deck.gimp = True


def _noted(key: str) -> Statement:
    def read(reader: Reader, deck: Deck) -> None:
        deck.note(f"{key}: {OUTPUT[key]}")

    return read


def _axis(axis: int) -> Statement:
    return lambda reader, deck: _span(reader, deck, axis)


STATEMENTS: dict[str, Statement] = {
    "mpm3": _title,
    "nbmp": _count("particles"),
    "nbbo": _count("bodies"),
    "nbco": _count("components"),
    "nmat": _count("material_count"),
    "grid": _grid,
    "spx": _axis(0),
    "spy": _axis(1),
    "spz": _axis(2),
    "dcel": _cell,
    "dtsc": _factor,
    "endt": _end,
    "outt": _interval,
    "rptt": _report,
    "fixe": _faces,
    "musl": _scheme("musl"),
    "usf": _scheme("usf"),
    "usl": _scheme("usl"),
    "jaum": _jaumann,
    "bulk": _bulk,
    "gimp": _gimp,
    "uvfp": _volume,
    "cont": _contact,
    "mate": blocks.material,
    "seos": blocks.equation_of_state,
    "deto": _points_of_detonation,
    "part": blocks.part,
    "load": acting.load,
    "velo": acting.velocity,
    "damp": acting.damping,
    "qulo": acting.rise,
    "tecp": _noted("tecp"),
    "para": _noted("para"),
    "smoo": _noted("smoo"),
    "outr": _variable,
    "curv": _curve,
    "curx": _curve_at,
    "pt2d": _filter,
}
