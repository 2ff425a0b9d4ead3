# SPDX-License-Identifier: BSD-3-Clause
"""Checks of a case across its tables: names that must exist, numbers per vector, defaults by D."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mpm3dpp import _core
from mpm3dpp.base.errors import CaseError, Path, nearest, report, violation
from mpm3dpp.base.expression import Expression
from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.base.model import plain
from mpm3dpp.base.outputs import COLUMNS, ON_REQUEST, STANDARD

from .cut import cut_bodies
from .detonation import check_detonations
from .forces import acts_at_first, check_forces, force_values
from .frame import check_frames
from .initial import check_initial
from .loads import check_loads
from .material_checks import check_material
from .motion import check_motion
from .pairs import check_bonds, check_pairs, check_pressed, presses
from .probe import check_probes
from .stop import check_stops

if TYPE_CHECKING:
    from mpm3dpp.grains import Grains

    from .body import Body
    from .case import Case


Found = Iterator[PydanticCustomError]


def check_case(case: Case) -> None:
    """Check a whole case and fill in the defaults that depend on the dimension.

    Raises:
        PydanticCustomError, ValidationError: one violation or several, with their paths.
    """
    first = list(_entries(case))
    report([*first, *check_pairs(case), *_interval(case)] if first else [])
    report([*_bodies_together(case), *check_pairs(case), *_output(case), *_interval(case)])


def _entries(case: Case) -> Found:
    """What an entry by itself has wrong, or its material's name and its numbers of components."""
    for name, what in (("material", case.material), ("body", case.body)):
        if not what and not (name == "body" and case.grains):
            yield violation("must not be empty", f"add a table [{name}.NAME]", path=(name,))
        if "" in what:
            yield violation("must have a name", "write [body.left]", path=(name, ""))
    for table in ("material", "body", "grains", "load"):
        for word in getattr(case, table):
            if not word.isprintable():
                rule = "has a character in its name that cannot be shown"
                yield violation(rule, "leave it out", path=(table, word))
    yield from _columns_of_their_own(case)
    for name, material in case.material.items():
        yield from check_material(material, ("material", name))
    dimension = case.grid.dimension
    yield from _check_vector(case.run, "gravity", dimension, ("run",))
    for name, body in case.body.items():
        yield from _check_body(case, body, ("body", name))
    yield from cut_bodies(case)
    for name, grains in case.grains.items():
        yield from _check_grains(case, name, grains)


def _bodies_together(case: Case) -> Found:
    if all(case.is_rigid(name) for name in case.parts()):
        rule = "holds rigid bodies only, so no wave limits the time step: one must deform"
        path: Path = ("body",) if case.body else ("grains",)
        yield violation(rule, "give one another strength, and no motion", path=path)
    yield from check_detonations(case)
    yield from check_loads(case)
    yield from check_stops(case)
    yield from check_probes(case, lambda material: _columns(case, material))
    yield from check_forces(case)
    yield from check_bonds(case)
    yield from check_pressed(case)
    yield from check_frames(case)
    yield from _dampings(case)
    if case.run.settle is not None and not acts_at_first(case) and not presses(case):
        rule = (
            "needs a force to settle under: at the time 0 there is no gravity, load or body force"
        )
        yield violation(rule, "give one, or remove it", path=("run", "settle"))
    yield from _transfer(case)
    yield from _springs(case)


def _transfer(case: Case) -> Found:
    """Refuse what does not go with the transfer."""
    word, basis = case.run.transfer.word, case.grid.basis
    if _core.transfers[word]["affine"] and not _core.bases[basis]["second_moment"]:
        known = [name for name, each in _core.bases.items() if each["second_moment"]]
        rule = f'does not go with grid.basis = "{basis}", whose second moment is not constant'
        remedy = f'use grid.basis = "{known[0]}"'
        yield violation(rule, remedy, value=word, path=("run", "transfer"))


def _springs(case: Case) -> Found:
    """Refuse what does not go with springs: they know where particles are, in every step."""
    contact = case.contact
    if contact.response == "impulses":
        return
    with_it = f'does not go with contact.response = "{contact.response}"'
    if contact.detection != "gap":
        rule, remedy = f"{with_it}, which act where particles overlap", "leave it out"
        yield violation(rule, remedy, value=contact.detection, path=("contact", "detection"))
    if contact.normal != "plane":
        rule = f"{with_it}, which act along the normals of the surfaces"
        yield violation(rule, "leave it out", value=contact.normal, path=("contact", "normal"))
    if contact.normal_refresh_distance > 0.0:
        rule, remedy = f"{with_it}, which are found in every step", "leave it out"
        path: Path = ("contact", "normal_refresh_distance")
        yield violation(rule, remedy, value=contact.normal_refresh_distance, path=path)


def _check_vector(owner: object, name: str, dimension: int, path: Path) -> Found:
    """Check the number of components of a vector and replace an absent one by zero."""
    vector = getattr(owner, name)
    if vector and len(vector) != dimension:
        rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
        remedy = f"it has {len(vector)}, give {dimension}"
        yield violation(rule, remedy, value=plain(vector), path=(*path, name))
        return
    owner.__dict__[name] = vector or (0.0,) * dimension


def _check_grains(case: Case, name: str, grains: Grains) -> Found:
    path: Path = ("grains", name)
    if not name or name in case.body:
        rule = "has the name of a body" if name else "must have a name"
        yield violation(rule, "write another name, [grains.sand]", path=path)
    wrong = grains.wrong_dimension(case.grid.dimension)
    if wrong is not None:
        yield violation(wrong[1], wrong[2], path=(*path, *wrong[0]))
        return
    try:
        names = grains.names(name)
    except CaseError as error:  # A shape that holds none.
        yield violation(error.rule, error.remedy, path=(*path, grains.filling))
        return
    others = {*case.body, *case.grains}
    taken = next((one for one in names if one in others), None)
    if taken is not None:
        rule = f"has a grain {taken}, which is the name of another entry too"
        yield violation(rule, "rename one of the two", path=path)
    yield from _check_motion(case, grains, path)


def _check_motion(case: Case, body: Body | Grains, path: Path) -> Found:
    """Check the material and the velocities, and fill in those that are absent."""
    dimension = case.grid.dimension
    if body.material not in case.material:
        rule, remedy = "is not a material of this case", nearest(body.material, case.material)
        yield violation(rule, remedy, value=body.material, path=(*path, "material"))
    yield from _check_vector(body, "velocity", dimension, path)
    yield from _formulas(body, dimension, path)
    spin, wanted = body.angular_velocity, 1 if dimension == 2 else 3
    if spin and len(spin) != wanted:
        numbers = "one number" if wanted == 1 else "three numbers"
        rule = f"must be {numbers}, as grid.dimension = {dimension}"
        example = '"10 rad/s"' if wanted == 1 else '[0, 0, "10 rad/s"]'
        remedy = f"for example {example}"
        yield violation(rule, remedy, value=plain(spin), path=(*path, "angular_velocity"))
        return
    body.__dict__["angular_velocity"] = spin or (0.0,) * wanted


def _formulas(body: Body | Grains, dimension: int, path: Path) -> Found:
    """Yield the formulas of places that there are in 3D only."""
    for name in ("velocity", "angular_velocity", "body_force"):
        for index, value in enumerate(getattr(body, name) or ()):
            if isinstance(value, Expression) and dimension == 2 and value.variables & {"z", "Z"}:
                rule = "is a formula of z, and grid.dimension = 2"
                where = (*path, name, index, "expression")
                yield violation(rule, "leave z out", value=value.text, path=where)


def _dampings(case: Case) -> Found:
    """Yield the damping of bodies that do not deform, or of some of those that move as one."""
    parts = case.parts()
    for name, part in parts.items():
        path = (*case.part_path(name), "damping")
        if part.damping is not None and case.is_rigid(name):
            rule = "is of a body that does not deform, and acts on bodies that do"
            remedy = "remove it, or give the body another material and no motion"
            yield violation(rule, remedy, path=path)
        other = next((one for one in parts if parts[one].damping != part.damping), None)
        if case.contact.bonded and part.damping is not None and other is not None:
            rule = "must be the same for all where contact.bonded = true: all bodies move as one"
            yield violation(rule, f"that of {other} is another", path=path)


def _check_body(case: Case, body: Body, path: Path) -> Found:
    dimension = case.grid.dimension
    if body.shape is not None:
        wrong = body.shape.wrong_dimension(dimension, (*path, "shape"))
        if wrong is not None:
            yield violation(wrong[1], wrong[2], path=wrong[0])
    if body.particles is not None and body.particles.dimension != dimension:
        rule = f"must have {dimension} coordinates, as grid.dimension = {dimension}"
        remedy = f"it has {body.particles.dimension}"
        value = body.particles.file or "an array"
        yield violation(rule, remedy, value=value, path=(*path, "particles"))
    yield from _check_motion(case, body, path)
    if body.motion is not None:
        yield from check_motion(case, body, path)
    if body.material in case.material:
        yield from check_initial(case, body, path)
    if body.particles is not None and body.particles.velocities is not None:
        given = [name for name in ("velocity", "angular_velocity") if any(getattr(body, name))]
        for name in [*given, *(["motion"] if body.motion is not None else [])]:
            rule = "must not be given together with particles that have velocities"
            yield violation(rule, "keep one of the two", path=(*path, name))


def _columns_of_their_own(case: Case) -> Found:
    """Bodies whose columns of the history would have one name: `a` eroded, and `a_eroded`."""
    owners: dict[str, str] = {}
    for name in case.parts():
        for column in (f"{name}_{number}" for number in _core.part_columns):
            other = owners.setdefault(column, name)
            if other != name:
                rule = f"has the column body_{column} of history.csv, as {other} has"
                yield violation(rule, "give it another name", path=case.part_path(name))
                break


def _columns(case: Case, material: str) -> list[str]:
    """Return the names of the columns that the core has for particles of a material."""
    parts = [part for part in case.parts().values() if part.material == material]
    given = [value for part in parts for value in force_values(part)]
    columns = partial(
        _core.column_names,
        dimension=case.grid.dimension,
        may_leave=case.grid.outflow_box is not None,
        forced=bool(given),
        of_start=any(isinstance(value, Expression) and value.is_of_start for value in given),
        transfer=case.run.transfer.word,
        springs=case.has_set_back,
        viscosity=case.viscosity_of(material),
        damping=case.material[material].beta,
        **case.material[material].for_core(),
    )
    frames = {part.frame == MATERIAL for part in parts}
    return list(dict.fromkeys(name for frame in frames for name in columns(in_body=frame)))


def _output(case: Case) -> Found:
    stored = dict.fromkeys(name for used in case.materials_used for name in _columns(case, used))
    extra = [name for name in (*ON_REQUEST, *stored) if name not in STANDARD]
    for index, word in enumerate(case.output.fields):
        if word not in (*STANDARD, *extra):
            rule = "is not a column that this case stores"
            remedy = nearest(word, extra)
            yield violation(rule, remedy, value=word, path=("output", "fields", index))
    colours = picture_names(case)
    if case.output.picture not in colours:
        remedy = nearest(case.output.picture, colours)
        if case.output.picture in extra:
            remedy = f'add it to output.fields: fields = ["{case.output.picture}"]'
        rule = "is not a column that colours a picture of this case"
        yield violation(rule, remedy, value=case.output.picture, path=("output", "picture"))


def _interval(case: Case) -> Found:
    interval = case.output.interval
    if interval is not None and case.run.end_time / interval > 100_000:
        rule = "gives more than 100000 frames"
        yield violation(rule, "give a longer interval", value=interval, path=("output", "interval"))


def picture_names(case: Case) -> list[str]:
    """Return what `output.picture` may be: stored columns, speed, and components of vectors."""
    axes = ("x", "y", "z")[: case.grid.dimension]
    stress = ("xx", "yy", "zz", "yz", "xz", "xy") if len(axes) == 3 else ("xx", "yy", "zz", "xy")
    names = [name for name in STANDARD if name not in COLUMNS]
    names += ["speed", *(f"velocity_{a}" for a in axes), *(f"stress_{s}" for s in stress)]
    return list(dict.fromkeys([*names, "velocity", "stress", *case.output.fields]))
