"""What a family declares: variables, parameters, quantities, choices and rules; and what a table holds of them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from . import names, units
from .checked import check_fields
from .diagnostics import FamilyError
from .polynomial import Powers

STATUSES = ("published", "derived", "unverified", "assumed")

POSITIVE, NOT_NEGATIVE, NOT_ZERO = "positive", "not_negative", "not_zero"
_IN_WORDS = {POSITIVE: "must be positive", NOT_NEGATIVE: "must not be negative", NOT_ZERO: "must not be zero"}


def check_texts(*texts: str) -> None:
    """Raise `FamilyError` for a text that cannot stand in one line."""
    fault = names.fault_of_texts(*texts)
    if fault is not None:
        raise FamilyError(fault)


def check_number(what: str, number: object) -> None:
    """Raise `FamilyError` for what is not a finite number."""
    if not isinstance(number, int | float) or not math.isfinite(number):
        raise FamilyError(f"{what} is {number!r}; it must be a finite number")


def _check(name: str, unit: str, symbol: str, doc: str) -> None:
    fault = names.fault_of_identifier(name)
    if fault is not None:
        raise FamilyError(fault)
    check_texts(symbol, doc)
    if not doc:
        raise FamilyError(f"`{name}` has no text that says what it is")
    try:
        units.dimensions(unit)
    except units.UnitError as error:
        raise FamilyError(f"the unit of `{name}`: {error}") from error


def _check_key(key: str, unit: str, symbol: str, doc: str) -> None:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", key):
        raise FamilyError(f"`{key}` is not a key of a table: letters, digits, `_`")
    _check(key.lower(), unit, symbol, doc)


def _check_sign(must: str | None) -> None:
    if must is not None and must not in _IN_WORDS:
        raise FamilyError(f"`{must}` is not a range; ranges: {', '.join(_IN_WORDS)}")


@dataclass(frozen=True)
class Variable:
    r"""A state, an input, a Wiener increment, an argument, or a derived variable such as the Mach number.

    `name` is its name in tables, commands and the generated code; `symbol` is LaTeX; `unit` is in foot and slug or in
    SI, whichever the author prefers. `bounds` names the interval of `[validity]` that holds for a state or an input;
    it is `name` unless several variables share one.

    >>> alpha = Variable("alpha", r"\alpha", "rad", "angle of attack")
    >>> mode = Variable("eta_1", r"\eta_1", "(ft*slug)^0.5", "coordinate of mode 1", bounds="eta")
    """

    name: str
    symbol: str
    unit: str
    doc: str
    bounds: str | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        _check(self.name, self.unit, self.symbol, self.doc)

    @property
    def interval(self) -> str:
        """The name of its interval in `[validity]`."""
        return self.bounds or self.name


@dataclass(frozen=True)
class Parameter:
    r"""A number that every table of the family has, by its key; `must` is its range, `above` what it exceeds.

    The name in the generated code is the key in lower case; before that of a part stands the name of its instance.

    >>> mass = Parameter("m", "m", "slug", "vehicle mass", POSITIVE)
    """

    key: str
    symbol: str
    unit: str
    doc: str
    must: str | None = None
    above: Parameter | None = None
    prefix: str = ""

    def __post_init__(self) -> None:
        check_fields(self)
        _check_key(self.key, self.unit, self.symbol, self.doc)
        _check_sign(self.must)
        if self.above is not None and units.dimensions(self.unit) != units.dimensions(self.above.unit):
            message = f"`{self.key}` is in `{self.unit}`; it cannot exceed `{self.above.key}`, in `{self.above.unit}`"
            raise FamilyError(message)

    @property
    def name(self) -> str:
        """Its name in the generated code."""
        return f"{self.prefix}{self.key}".lower()

    def rules(self) -> tuple[Rule, ...]:
        """Its range, and what it exceeds."""
        own, found = (1.0, (self.name,)), []
        if self.must is not None:
            reason = f"`{self.key}` ({self.doc}) {_IN_WORDS[self.must]}"
            found.append(Rule(self.must.replace("_", "-"), (own,), self.must, reason))
        if self.above is not None:
            other = replace(self.above, prefix=self.prefix)
            reason = f"`{self.key}` ({self.doc}) must exceed `{other.key}` ({other.doc})"
            found.append(Rule("above", (own, (-1.0, (other.name,))), POSITIVE, reason))
        return tuple(found)


def check_order(parameters: Iterable[Parameter], known: Iterable[str] = ()) -> None:
    """Raise `FamilyError` for a parameter that must exceed one that is not declared before it."""
    before = list(known)
    for one in parameters:
        if one.above is not None and one.above.name not in before:
            raise FamilyError(f"`{one.key}` must exceed `{one.above.key}`, which is not declared before it")
        before.append(one.name)


@dataclass(frozen=True)
class Quantity:
    r"""A curve-fitted quantity: a section of the table, whose keys are monomials in the variables `depends_on`.

    Every variable may be a state, an input, or a derived variable that the model defines before it asks for the fit.
    `required` are variables whose linear coefficient a table must list, for the reason `required_by`; in the variables
    `affine` together the fit is of degree one at most, for the reason `affine_by`.

    >>> alpha = Variable("alpha", r"\alpha", "rad", "angle of attack")
    >>> mach = Variable("mach", "M", "1", "Mach number")
    >>> lift = Quantity("C_L", "C_L", "1", "lift coefficient", depends_on=(alpha, mach))
    """

    key: str
    symbol: str
    unit: str
    doc: str
    depends_on: Sequence[Variable]
    required: Sequence[str] = ()
    required_by: str = ""
    affine: Sequence[str] = ()
    affine_by: str = ""

    def __post_init__(self) -> None:
        check_fields(self)
        _check_key(self.key, self.unit, self.symbol, self.doc)
        if len(set(self.variables)) != len(self.variables):
            raise FamilyError(f"`{self.key}` depends twice on one of {', '.join(self.variables)}")
        for name in (*self.required, *self.affine):
            if name not in self.variables:
                raise FamilyError(f"`{self.key}` does not depend on `{name}`")

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables of its monomials, in the order in which the name of a coefficient has them."""
        return tuple(variable.name for variable in self.depends_on)

    def unit_of(self, powers: Powers) -> str:
        """The unit of the coefficient of a monomial."""
        of = {variable.name: variable.unit for variable in self.depends_on}
        unit = self.unit
        for name, exponent in powers:
            for _ in range(exponent):
                unit = units.quotient(unit, of[name])
        return unit


@dataclass(frozen=True)
class Rule:
    """A condition on the parameters: a polynomial in them is positive, not negative or not zero.

    A term is a factor and the names of the parameters that multiply it; coefficients count as parameters (`c_l_alpha`).
    A fault is reported at the first of them, with `reason` as its text.

    >>> Rule("inertia", ((1.0, ("i_yy",)), (-1.0, ("psi", "psi"))), POSITIVE, "I_yy must exceed psi^2").holds(
    ...     {"i_yy": 2.0, "psi": 1.0}
    ... )
    True
    """

    name: str
    terms: tuple[tuple[float, tuple[str, ...]], ...]
    must: str
    reason: str

    def __post_init__(self) -> None:
        check_fields(self)
        _check_sign(self.must)
        if not any(factors for _, factors in self.terms):
            raise FamilyError(f"the rule `{self.name}` is about no parameter")
        for factor, _ in self.terms:
            check_number(f"a factor of the rule `{self.name}`", factor)

    def holds(self, values: Mapping[str, float]) -> bool:
        """Whether parameters of these values keep the rule; one that is not a number does not."""
        # A product overflows to infinity, a power to an exception.
        value = sum(factor * math.prod(values[name] for name in names) for factor, names in self.terms)
        return {POSITIVE: value > 0, NOT_NEGATIVE: value >= 0, NOT_ZERO: abs(value) > 0}[self.must]

    def check_dimensions(self, unit_of: Callable[[str], str]) -> None:
        """Raise `FamilyError` where its terms, of parameters in these units, have unlike dimensions."""
        found: list[units.Dimensions] = []
        for _, factors in self.terms:
            unit = "1"
            for name in factors:
                unit = units.quotient(unit, units.quotient("1", unit_of(name)))
            found.append(units.dimensions(unit))
        for other in found[1:]:
            if not units.alike(found[0], other):
                unlike = f"{units.in_words(found[0])} and {units.in_words(other)}"
                raise FamilyError(f"the terms of the rule `{self.name}` have unlike dimensions, {unlike}")

    def parameters(self) -> tuple[str, ...]:
        """The parameters that it is about, the one at which a fault is reported first."""
        return tuple(dict.fromkeys(name for _, names in self.terms for name in names))


@dataclass(frozen=True)
class Option:
    """One way to choose, and the values of the switches that it sets."""

    name: str
    doc: str
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        check_fields(self)


@dataclass(frozen=True)
class Choice:
    """A key of `[choices]`, its type in the generated code, its switches and its options.

    A choice changes no code: it sets switches, which are parameters.

    >>> earth = Choice(
    ...     "earth", "Earth", "Earth",
    ...     (switch("spherical_earth", "s_E", "share of the curvature: 1 spherical, 0 flat"),),
    ...     (Option("flat", "constant gravity", (0.0,)), Option("spherical", "gravity falls", (1.0,))),
    ... )
    """

    name: str
    type_name: str
    doc: str
    switches: tuple[Parameter, ...]
    options: tuple[Option, ...]

    def __post_init__(self) -> None:
        check_fields(self)
        if not self.options or any(len(option.values) != len(self.switches) for option in self.options):
            raise FamilyError(f"every option of `{self.name}` sets all of its switches")
        for option in self.options:
            for value in option.values:
                check_number(f"a value of the option `{option.name}` of `{self.name}`", value)
            if not re.fullmatch(r"[a-z][a-z0-9_]*", option.name):
                raise FamilyError(f"the option `{option.name}` of `{self.name}` is not a lower-case identifier")
        check_texts(self.doc, *(option.doc for option in self.options))


def switch(key: str, symbol: str, doc: str) -> Parameter:
    """A parameter that a choice sets, a pure number."""
    return Parameter(key, symbol, "1", doc)


@dataclass(frozen=True)
class Schema:
    """What the table of some models of a family holds; `laws` are the rules about more than one parameter's range."""

    parameters: Mapping[str, tuple[Parameter, ...]]
    validity: tuple[Variable, ...]
    choices: tuple[Choice, ...] = ()
    quantities: tuple[Quantity, ...] = ()
    laws: tuple[Rule, ...] = ()

    def holds(self, section: str, key: str) -> bool:
        """Whether a table has an entry of this key in this section, or may have it in the polynomial of a quantity."""
        keys = {
            "choices": [choice.name for choice in self.choices],
            "validity": [variable.name for variable in self.validity],
        } | {name: [one.key for one in group] for name, group in self.parameters.items()}
        return key in keys.get(section, ()) or any(section == quantity.key for quantity in self.quantities)

    def rules(self) -> tuple[Rule, ...]:
        """The ranges of the parameters, then the laws."""
        ranges = (rule for group in self.parameters.values() for one in group for rule in one.rules())
        return (*ranges, *self.laws)
