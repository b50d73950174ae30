"""Checks of what a family's file hands to the modelling API: each argument is what its annotation says."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import numbers
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import ParamSpec, TypeVar

import casadi as ca

from .diagnostics import FamilyError, shortened

_P = ParamSpec("_P")
_R = TypeVar("_R")

# Where a value is inside an argument, the value, and what it should be.
_Fault = tuple[str, object, str]

# Types of what is declared; in equations a symbol stands for it.
DECLARATIONS = ("Variable", "Parameter")

_WORDS = {str: "a text", float: "a number", bool: "True or False", ca.SX: "an expression", type(None): "None"}


def checked(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Decorates a function of the API: an argument of another type is a `FamilyError` that names it."""
    signature = inspect.signature(function)
    hints: dict[str, object] = {}

    @functools.wraps(function)
    def call(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        try:
            bound = signature.bind(*args, **kwargs)
        except TypeError:
            return function(*args, **kwargs)  # Python's own message names the function.
        if not hints:
            hints.update(typing.get_type_hints(function))
        for name, value in bound.arguments.items():
            kind, hint = signature.parameters[name].kind, hints.get(name, typing.Any)
            if isinstance(value, Iterator):
                value = bound.arguments[name] = tuple(value)  # Looked at more than once.
            several = kind is inspect.Parameter.VAR_POSITIONAL
            _refuse(function.__qualname__, name, value, Sequence[hint] if several else hint)  # type: ignore[valid-type]
        return function(*bound.args, **bound.kwargs)

    return call


def check_fields(of: object) -> None:
    """Raise `FamilyError` for a field of a dataclass that is not what its annotation says."""
    hints = _hints_of(type(of))  # type: ignore[arg-type]
    for field in dataclasses.fields(of):  # type: ignore[arg-type]
        _refuse(type(of).__name__, field.name, getattr(of, field.name), hints[field.name])


# A family has thousands of variables and parameters.
_hints_of = functools.cache(typing.get_type_hints)


def _refuse(function: str, argument: str, value: object, hint: object) -> None:
    for inside, found, expected in _faults(value, hint):
        declared = type(found).__name__ in DECLARATIONS and _WORDS[ca.SX] in expected
        advice = "in equations its symbol stands for it: `model[...]`" if declared else None
        raise FamilyError(f"`{function}`: `{argument}{inside}` is {_described(found)}; expected is {expected}", advice)


def _faults(value: object, hint: object) -> Iterator[_Fault]:
    """What is amiss in a value."""
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin in (typing.Union, types.UnionType):
        found = [list(_faults(value, one)) for one in _merged(arguments)]
        if all(found):
            # Inside the container that was meant, or the whole.
            yield from next((of for of in found if of[0][0]), [("", value, _in_words(hint))])
    elif origin is tuple and isinstance(value, tuple) and arguments[-1] is not Ellipsis:
        if len(value) != len(arguments):
            yield "", value, _in_words(hint)
        else:
            yield from _inside(((f"[{i}]", one) for i, one in enumerate(value)), arguments)
    elif origin is Mapping and isinstance(value, Mapping):
        for key, one in value.items():
            yield from ((" (a key)", *fault[1:]) for fault in _faults(key, arguments[0]))
            yield from _inside([(f"[{_described(key)}]", one)], arguments[1:])
    elif origin in (tuple, Sequence, Iterable) and isinstance(value, Iterable) and not isinstance(value, str | ca.SX):
        several = [(f"[{i}]", one) for i, one in enumerate(value)]
        yield from _inside(several, [arguments[0]] * len(several))
    elif not _is(value, origin or hint):
        yield "", value, _in_words(hint)


def _inside(values: Iterable[tuple[str, object]], hints: Iterable[object]) -> Iterator[_Fault]:
    for (at, value), hint in zip(values, hints, strict=True):
        yield from ((at + inside, found, expected) for inside, found, expected in _faults(value, hint))


def _is(value: object, hint: object) -> bool:
    """Whether a value is of a type that holds no others."""
    if hint is float:
        return isinstance(value, numbers.Real) and not isinstance(value, bool)
    if hint is ca.SX:
        return isinstance(value, ca.SX) and bool(value.is_scalar())
    if hint in (tuple, Sequence, Iterable, Mapping):
        return False
    if hint is Callable:
        return callable(value)
    return not isinstance(hint, type) or hint is typing.Any or isinstance(value, hint)


def _merged(hints: tuple[object, ...]) -> list[object]:
    """Alternatives; those that are mappings are one, whose keys may be mixed."""
    mappings = [typing.get_args(hint) for hint in hints if typing.get_origin(hint) is Mapping]
    others = [hint for hint in hints if typing.get_origin(hint) is not Mapping]
    if not mappings:
        return others
    keys, values = (typing.Union[tuple(of)] for of in zip(*mappings, strict=True))  # noqa: UP007
    return [*others, Mapping[keys, values]]  # type: ignore[valid-type]


def _in_words(hint: object) -> str:
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin in (typing.Union, types.UnionType):
        *words, last = dict.fromkeys(_in_words(one) for one in _merged(arguments))
        return f"{', '.join(words)} or {last}" if words else last
    if origin is tuple and arguments[-1] is not Ellipsis:
        return f"a tuple ({', '.join(map(_in_words, arguments))})"
    if origin is Mapping:
        return f"a dictionary from {_in_words(arguments[0])} to {_in_words(arguments[1])}"
    if origin in (tuple, Sequence, Iterable):
        return f"a list, each of it {_in_words(arguments[0])}"
    if origin is Callable:
        return "a function"
    name = getattr(hint, "__name__", str(hint))
    return _WORDS.get(hint, f"{'an' if name[0] in 'AEIOU' else 'a'} {name}")  # type: ignore[call-overload, no-any-return]


def _described(value: object) -> str:
    """A value in a message."""
    if isinstance(value, str):
        return f"the text {shortened(value)!r}"
    if isinstance(value, ca.SX):
        shape = "" if value.is_scalar() else f" of {value.size1()} by {value.size2()}"
        return f"the expression{shape} `{shortened(str(value))}`"
    if value is None or isinstance(value, bool | numbers.Number):
        return f"`{value}`"
    kind, name = type(value).__name__, getattr(value, "name", None)
    return f"the {kind} `{name}`" if isinstance(name, str) else f"of the type `{kind}`"
