# SPDX-License-Identifier: BSD-3-Clause
"""The typed case: what a TOML file, the Python API and importers all become. SI units throughout.

>>> case = load_case("case.toml")
>>> case.grid.cell_size, case.body["left"].velocity
(0.0008, (30.0, 0.0))
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import accumulate
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, from_validation, key_text
from mpm3dpp.base.errors import Path as KeyPath
from mpm3dpp.base.model import CaseModel, Choice, Text
from mpm3dpp.grains import Grains
from mpm3dpp.materials.catalogue import catalogue

from . import file as case_file
from .body import Body
from .box import CONTACT
from .changes import paths_of, with_changes
from .checks import check_case
from .choices import with_choices, with_picture
from .choose_frames import choose_frames
from .content import PRESETS, content_of, hash_of, with_preset
from .detonation import Detonation
from .frame import all_in_bodies, in_body
from .grid import Grid
from .loads import Load
from .material import Material as Material  # also for those who import it from here
from .parts import Contact, Output, Run
from .probe import Probe
from .schema import schema_of


class Case(CaseModel):
    """A whole problem, checked: `Grid`, `Run`, `Output`, `Contact`, `Material`, `Body`, `Grains`.

    Attributes:
        title: one line for pictures and results.
        preset: "paper" for the choices of Ma, Zhang & Huang (2010) where the case says nothing:
            the linear basis, and lattices of particles.
        material, body, grains: by name, in the order of the file. The bodies of `grains` are
            numbered after those of `body`.
        load: pressures and tractions on surfaces, by name.
        detonation: the points at which explosives are lit.
        probe: what is looked at on the way, by name.
        text: the file's text, empty for a case built in Python or with keys changed.
        source: the file's path, None for a case built in Python.
        file_path: the whole path of the file that was read, as text; empty where none was.
    """

    title: Text = ""
    preset: Annotated[str, Choice(PRESETS)] | None = None
    grid: Grid
    run: Run
    output: Output = Field(default_factory=Output)
    contact: Contact = Field(default_factory=Contact)
    material: Annotated[dict[str, Material], Field()]
    body: Annotated[dict[str, Body], Field(default_factory=dict)]
    grains: Annotated[dict[str, Grains], Field(default_factory=dict)]
    load: Annotated[dict[str, Load], Field(default_factory=dict)]
    detonation: list[Detonation] = Field(default_factory=list)
    probe: Annotated[dict[str, Probe], Field(default_factory=dict)]

    _text: str = PrivateAttr("")
    _changes: dict[tuple[str, ...], Any] = PrivateAttr(default_factory=dict)
    _source: Path | None = PrivateAttr(None)
    _file_path: str = PrivateAttr("")
    _lines: dict[KeyPath, int] = PrivateAttr(default_factory=dict)
    _why_in_space: dict[str, str] = PrivateAttr(default_factory=dict)
    _in_space: str = PrivateAttr("")  # Why no frame may be chosen, if there is a reason.

    @classmethod
    def complete(cls, data: Any) -> Any:
        """Return the tables with what the preset adds to them."""
        return with_preset(data)

    @model_validator(mode="after")
    def _whole(self) -> Case:
        self.complete_and_check()
        return self

    def complete_and_check(self) -> None:
        """Choose what the case leaves out, and check it; again where its tables were changed.

        Raises:
            ValueError: a violation, of which the sentence is made where the case is read or run.
        """
        self._why_in_space = choose_frames(self, self._in_space)
        flows = any(self.flows(part) for part in self.parts())
        frames = bool(in_body(self)), not all_in_bodies(self)
        chosen = with_choices(self.grid.basis, self.run, self.contact, flows, *frames)
        self.__dict__ |= chosen | with_picture(self)
        check_case(self)

    @property
    def why_in_space(self) -> dict[str, str]:
        """Why the nodes of an entry lie in space, by its name; "" where they lie in the body.

        Of those alone whose frame is "auto" and that deform.
        """
        return dict(self._why_in_space)

    @property
    def text(self) -> str:
        """Text of the case file; empty for a case built in Python, or with keys changed."""
        return "" if self._changes else self._text

    @property
    def source(self) -> Path | None:
        """Path of the case file; None for a case built in Python."""
        return self._source

    @property
    def file_path(self) -> str:
        """Whole path of the file that was read, as text; empty where none was."""
        return self._file_path

    def note_file(self, path: Path) -> None:
        """Note the file that the case was just read from, before the current folder changes."""
        self._file_path = str(path.resolve())

    @classmethod
    def from_file(cls, path: str | Path) -> Case:
        """Read and check a case file.

        Args:
            path: a TOML file.

        Returns:
            The case, in SI units.

        Raises:
            CaseError: the file cannot be read or breaks a rule; the sentence says where.
        """
        path = arguments.path("path", path)
        case = cls.from_text(case_file.read_text(path), str(path))
        case.note_file(path)
        return case

    @classmethod
    def from_text(cls, text: str, name: str = "case.toml") -> Case:
        """Read and check a case from TOML text; `name` is that of its file, for messages.

        Files that it names are looked for in the folder of `name`.
        """
        tables = case_file.parse(text, name)
        case = cls.from_tables(tables, name, case_file.locate_keys(text, name))
        case._text = text
        return case

    @classmethod
    def from_tables(cls, tables: dict[str, Any], name: str, lines: dict[KeyPath, int]) -> Case:
        """Check a case that a file gave as tables.

        Args:
            tables: of the case.
            name: of the file, for messages and for the files that it names.
            lines: line of each key; a key that is not there has the line of its table.
        """
        try:
            case = cls.model_validate(tables, context={"folder": Path(name).parent})
        except ValidationError as error:
            raise from_validation(error, case_file.locator(lines, name)) from None
        except RecursionError:
            raise case_file.too_deep(name) from None
        case._lines, case._source = lines, Path(name)
        return case

    def with_(self, changes: Mapping[str, Any]) -> Case:
        """Return this case with other values of some keys: `case.with_({"contact.friction": 0.2})`.

        A value is a number in SI units, text with a unit, a list or a table; None takes the key
        out, if it is there. Places in lists count from 0: `contact.pair.0.friction`. Raises
        `CaseError` for a case of no file, a key that there is not, and what breaks a rule.
        """
        return with_changes(self, paths_of(changes))

    @property
    def case_hash(self) -> str:
        """SHA-256 (hexadecimal) of the case in SI units, keys sorted.

        It depends neither on formatting nor on units nor on the names of files of particles.
        """
        return hash_of(self.content())

    def content(self) -> dict[str, Any]:
        """Return what a run writes, when it was asked for: the table, numbers to 12 digits.

        Hashes stand in place of names of files, and what fills the shapes in place of a preset;
        when checkpoints are written is left out.
        """
        return content_of(self)

    def parts(self) -> dict[str, Body | Grains]:
        """Return the entries of `body` and `grains` by name, in the order of their bodies."""
        return {**self.body, **self.grains}

    def filled_by(self, part: str) -> str:
        """Return "shells", "faces" or "lattice": what fills an entry of `body` or `grains`."""
        return self.parts()[part].filled_by(self.preset)

    def part_path(self, name: str) -> KeyPath:
        """Return the path of an entry of `body` or `grains`."""
        return "grains" if name in self.grains else "body", name

    @property
    def materials_used(self) -> list[str]:
        """Names of the materials that a body has, in the order of the bodies."""
        return list(dict.fromkeys(part.material for part in self.parts().values()))

    @property
    def body_count(self) -> int:
        """Number of bodies, each grain counted."""
        return len(self.body) + sum(grains.count for grains in self.grains.values())

    @property
    def contact_enabled(self) -> bool:
        """Whether contact is computed: not switched off, nor bonded, and at least two bodies."""
        return self.contact.enabled and not self.contact.bonded and self.body_count > 1

    @property
    def has_springs(self) -> bool:
        """Whether any bodies in contact push each other by springs."""
        return self.contact_enabled and self.contact.response != "impulses"

    @property
    def has_set_back(self) -> bool:
        """Whether springs push particles, of bodies or at walls, which may be set back for them."""
        return self.has_springs or CONTACT in self.grid.walls

    def flows(self, part: str) -> bool:
        """Return whether a body has no shape of its own: a gas, a liquid, an explosive.

        Args:
            part: name of the body, or of an entry of grains.
        """
        material = self.material.get(self.parts()[part].material)
        return material is not None and catalogue()[material.strength.model].flows

    def is_rigid(self, part: str) -> bool:
        """Return whether a body does not deform: by its material, or by a prescribed motion.

        Args:
            part: name of the body, or of an entry of grains.
        """
        entry = self.parts()[part]
        moves = isinstance(entry, Body) and entry.motion is not None
        return moves or not self.material[entry.material].sound_speed()

    def viscosity_of(self, material: str) -> tuple[float, float]:
        """Return a material's quadratic and linear factors of artificial viscosity; 0, 0: none."""
        return self.material[material].viscosity_in(self.run.viscosity)

    def first_bodies(self) -> dict[str, int]:
        """Return the number of the first body of every entry of `body` and `grains`."""
        counts = [1] * len(self.body) + [grains.count for grains in self.grains.values()]
        return dict(zip(self.parts(), accumulate(counts, initial=0), strict=False))

    def frame_times(self) -> list[float]:
        """Return the times of the frames [s], the first 0 and the last the end time."""
        end = self.run.end_time
        if self.output.interval is None:
            count = self.output.frames or 50
            return [end * k / count for k in range(count)] + [end]
        count = int(end / self.output.interval * (1 - 1e-9))
        return [k * self.output.interval for k in range(count + 1)] + [end]

    def error(self, path: KeyPath, rule: str, remedy: str = "", **value: Any) -> CaseError:
        """Return a `CaseError` about a key of this case, with its line where it has one.

        Args:
            path: for example `("body", "left", "shape")`.
            rule: what must hold.
            remedy: what the user can do.
            value: `value=...`, the value at fault.
        """
        place = case_file.locator(self._lines, str(self._source))(path) if self._lines else ""
        return CaseError(rule, remedy, key=key_text(path), place=place, **value)

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """Return the JSON schema of case files, for editors that complete and check TOML."""
        return schema_of(cls)


def load_case(path: str | Path) -> Case:
    """Read and check a case file; the same as `Case.from_file`."""
    return Case.from_file(path)
