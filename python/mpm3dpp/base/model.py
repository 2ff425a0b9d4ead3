# SPDX-License-Identifier: BSD-3-Clause
"""The base of every object of a case: pydantic models whose mistakes are `CaseError` sentences."""

from __future__ import annotations

import contextlib
import operator
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import BaseModel, ConfigDict, PrivateAttr, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from .absent_keys import unknown_key
from .errors import (
    MISSING,
    CaseError,
    from_validation,
    nearest,
    report,
    violation,
    violations_of,
)

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)


class _CaseMeta(ModelMetaclass):
    """Turns pydantic's error into ours when a user makes an object; nested checks pass by here."""

    by_position: str  # The field that values without a name belong to; empty for none.

    def __call__(cls, *args: Any, **kwargs: Any) -> Any:
        fields: dict[str, Any] = cls.__dict__["__pydantic_fields__"]
        if args and cls.by_position and cls.by_position not in kwargs:
            alone = len(args) == 1 and isinstance(args[0], list | tuple)
            kwargs[cls.by_position] = list(args[0] if alone else args)
        elif args:
            keys = ", ".join(f"{name}=..." for name in fields)
            rule = "takes its values by name"
            raise CaseError(rule, f"write {cls.__name__}({keys})", key=cls.__name__)
        try:
            return super().__call__(**kwargs)
        except ValidationError as error:
            raise from_validation(error, prefix=(_table_name(cls.__name__),)) from None


class CaseModel(BaseModel, metaclass=_CaseMeta):
    """Base of the objects of a case. Unknown keys are errors; assignments are checked.

    Raises:
        CaseError: at construction or assignment, when a value breaks a rule.
    """

    by_position: ClassVar[str] = ""
    formerly: ClassVar[dict[str, str]] = {}  # Key of the release before -> key, for this one.
    _renamed: tuple[str, ...] = PrivateAttr(())  # Those keys that were given.
    model_config = ConfigDict(
        extra="forbid", validate_assignment=True, protected_namespaces=(), defer_build=True
    )

    @model_validator(mode="wrap")
    @classmethod
    def _known_keys(cls, data: Any, handler: Any) -> Any:
        """Report every unknown key, and then the mistakes of those that are known."""
        if isinstance(data, cls):
            return handler(data)
        data = cls.complete(data)
        if not isinstance(data, dict):
            remedy = "write it as { key = value, ... }"
            raise violation("must be a table", remedy, value=data)
        data, renamed = cls._present_keys(data)
        known = {key: value for key, value in data.items() if key in cls.model_fields}
        found = []
        for key in data:
            if key not in known:
                rule, remedy = unknown_key(str(key), cls.model_fields)
                found.append(violation(rule, remedy, path=(str(key),)))
        try:
            made = handler(known)
            if not found:
                made._renamed = renamed
                return made
        except (ValidationError, PydanticCustomError) as error:
            if not found and not renamed:
                raise
            given = {cls.formerly[key]: key for key in renamed}
            meant = " ".join(v.context["remedy"].partition("?")[0] for v in found if v.context)
            for other in violations_of(error):
                path = other["path"]
                name = path[-1] if path else ""
                if other["rule"] != MISSING or f'"{name}"' not in meant:
                    path = (given.get(path[0], path[0]), *path[1:]) if path else path
                    rule, remedy, value = other["rule"], other["remedy"], other["value"]
                    found.append(violation(rule, remedy, value=value, path=path))
        report(found)
        return data

    @classmethod
    def _present_keys(cls, data: dict[Any, Any]) -> tuple[dict[Any, Any], tuple[str, ...]]:
        """Return the table with its keys of now, and those of before that were given."""
        renamed = tuple(key for key in data if key in cls.formerly)
        for key in renamed:
            if (now := cls.formerly[key]) in data:
                rule = f"is the former name of the key {now}, which is given too"
                raise violation(rule, f"remove {key}", path=(key,))
        return {cls.formerly.get(key, key): value for key, value in data.items()}, renamed

    def renamed_keys(self) -> dict[str, str]:
        """Return the keys of the release before that were given, with their names of now."""
        return {key: self.formerly[key] for key in self._renamed}

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            now = type(self).formerly.get(name)
            return super().__getattr__(name) if now is None else getattr(self, now)

    @classmethod
    def complete(cls, data: Any) -> Any:
        """Return what a user gave with what it leaves out, before it is checked."""
        return data

    def __setattr__(self, name: str, value: Any) -> None:
        try:
            super().__setattr__(type(self).formerly.get(name, name), value)
        except ValidationError as error:
            raise from_validation(error, prefix=(_table_name(type(self).__name__),)) from None

    def _repr_html_(self) -> str:
        """What a notebook shows: the keys that were given, in SI units."""
        from .model_html import model_html

        return model_html(self)

    def table(self) -> dict[str, Any]:
        """Return the object as a table of a case file, in SI units, without absent keys."""
        pairs = ((name, getattr(self, name)) for name in type(self).model_fields)
        return {name: plain(value) for name, value in pairs if value is not None}


def plain(value: Any) -> Any:
    """Return a value of a case as tables, lists, numbers and text."""
    if hasattr(value, "table"):
        return value.table()
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value


def _table_name(name: str) -> str:
    """Return a class name as a table name: `GridBox` is `grid_box`."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


@dataclass(frozen=True)
class Choice:
    """Annotation of a field: one of a few words. `aliases` maps other words to these."""

    words: tuple[str, ...]
    aliases: tuple[tuple[str, str], ...] = ()

    def parse(self, value: Any) -> str:
        """Return the word, or raise the violation that pydantic collects."""
        word = dict(self.aliases).get(value, value) if isinstance(value, str) else value
        if word in self.words:
            return str(word)
        if isinstance(value, str):
            known = [*self.words, *dict(self.aliases)]
            raise violation("is not a known choice", nearest(value, known), value=value)
        raise violation("must be a word", f"valid here: {', '.join(self.words)}", value=value)

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        return {"type": "string", "enum": [*self.words, *dict(self.aliases)]}


_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]")  # All but tab and line end.


@dataclass(frozen=True)
class Exactly:
    """Annotation of a field of one plain type: whole numbers, text or true/false, never mixed."""

    kind: type
    least: int | None = None
    most: int | None = None

    def parse(self, value: Any) -> Any:
        """Return the value, or raise the violation that pydantic collects."""
        names = {int: "a whole number", str: "text", bool: "true or false"}
        examples = {int: str(self.least or 1), str: '"steel"', bool: "true"}
        give = f"give {names[self.kind]} such as {examples[self.kind]}"
        if self.kind is int and hasattr(value, "__index__") and not isinstance(value, bool):
            with contextlib.suppress(TypeError):  # an array is none, though it has the method
                value = operator.index(value)
        if type(value) is not self.kind:
            raise violation(f"must be {names[self.kind]}", give, value=value)
        if isinstance(value, str) and _CONTROL.search(value):
            rule = "has a character that cannot be shown"
            raise violation(rule, "leave it out", value=value)
        checked: Any = value
        if self.least is not None and checked < self.least:
            raise violation(f"must be >= {self.least}", give, value=value)
        if self.most is not None and checked > self.most:
            raise violation(f"must be <= {self.most}", f"give at most {self.most}", value=value)
        return checked

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        limits = {"minimum": self.least, "maximum": self.most}
        name = {int: "integer", str: "string", bool: "boolean"}[self.kind]
        return {"type": name, **{key: value for key, value in limits.items() if value is not None}}


Text = Annotated[str, Exactly(str)]
Flag = Annotated[bool, Exactly(bool)]
MOST = 10**15  # Of a whole number: the core and doubles hold it, and no case needs more.
Count = Annotated[int, Exactly(int, 1, MOST)]
