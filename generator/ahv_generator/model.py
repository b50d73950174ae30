"""A derived model: its named vectors, its quantities, and the functions that are emitted."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import casadi as ca

from . import motion, names, stochastic, units
from .checked import checked
from .derivation import Derivation
from .diagnostics import FamilyError, Once, suggestion
from .function import Entry, NoiseStructure, Output
from .graph import Intermediate
from .polynomial import Polynomial
from .schema import Parameter, Quantity, Variable, check_texts
from .traits import Equation, Given, Mode, Named, Sought, Traits, Trim, name_of

Number = ca.SX | float
Rates = Mapping[Variable, Number] | Mapping[str, Number]
Gains = Mapping[tuple[Variable, Variable], Number] | Mapping[tuple[str, str], Number]


@dataclass
class Model(Derivation):
    """A model under construction: what a family's function is given, and states the equations with.

    Expressions are CasADi scalars: `model[alpha]` is the symbol of a state, an input, a parameter or a quantity, and
    `+ - * / **`, `sin`, `cos`, `exp`, `sqrt` make others. Every quantity has a name, a symbol, a unit and a text, which
    travel into the generated code; its dimensions are checked where it is defined.
    """

    traits: Traits = field(default_factory=Traits)
    noise_structure: NoiseStructure | None = None
    rates: dict[str, ca.SX] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._section, self._equation = self.title, ""
        self._once = Once()
        # Of a quantity the unit that its author states it in; the graph has those of the table.
        self._units: dict[str, str] = {}

    # Quantities

    @checked
    def __getitem__(self, named: Named | Parameter) -> ca.SX:
        """The symbol of a quantity, a state, an input, a parameter or an argument, by its declaration or its name.

        Of a parameter the name or the key will do; a quantity of the same name comes before it.
        """
        name = name_of(named)
        places = (name, *(f"{prefix}.{name}" for prefix in "xut"), f"p.{name.lower()}")
        for known in places[-1:] if isinstance(named, Parameter) else places:
            if known in self.graph.symbols:
                return self.graph.symbols[known]
        known_names = [symbol.rpartition(".")[2] for symbol in self.graph.symbols]
        raise FamilyError(f"`{name}` is not defined in `{self.name}` before this line", suggestion(name, known_names))

    @property
    def parameters(self) -> dict[str, ca.SX]:
        """The symbols of all parameters and coefficients, by their names in the generated code."""
        return {p.name: self.graph.symbols[f"p.{p.name}"] for p in self.table.parameters}

    @checked
    def symbols(self, *named: Named | Parameter) -> tuple[ca.SX, ...]:
        """Several symbols at once: `V, gamma = model.symbols(velocity, path_angle)`."""
        return tuple(self[one] for one in named)

    @checked
    @contextlib.contextmanager
    def section(self, title: str, equation: str = "") -> Iterator[None]:
        """A section of the paper: `with model.section("Air", "(2)"):`.

        Quantities that are defined inside stand under this title and carry this equation number.
        """
        check_texts(title, equation)
        outer = self._section, self._equation
        self._section, self._equation = title, equation
        try:
            yield
        finally:
            self._section, self._equation = outer

    @checked
    def define(
        self,
        name: Named,
        expr: ca.SX | float,
        symbol: str = "",
        unit: str = "",
        doc: str = "",
        *,
        equation: str | None = None,
    ) -> ca.SX:
        """Name a quantity, and return its symbol.

        A declared `Variable` as the name brings symbol, unit and text with it: so a derived variable, such as the Mach
        number, is defined before a curve fit in it.

        Raises:
            ExpressionError: when the dimensions of the expression are not those of the unit.
            FamilyError: when the name is taken.
        """
        if isinstance(name, Variable):
            symbol, unit, doc = symbol or name.symbol, unit or name.unit, doc or name.doc
        plain = name_of(name)
        fault = names.fault_of_quantity(plain)
        if fault is not None:
            raise FamilyError(fault)
        check_texts(symbol, doc)
        if not doc:
            raise FamilyError(f"`{plain}` has no text that says what it is")
        if any(place in self.graph.symbols for place in (plain, *(f"{prefix}.{plain}" for prefix in "xut"))):
            raise FamilyError(f"the name `{plain}` is used twice in `{self.name}`")
        self._units[plain] = unit
        return self.graph.define(
            plain,
            ca.SX(expr),
            symbol=symbol,
            unit=unit,
            doc=doc,
            equation=self._equation if equation is None else equation,
            section=self._section,
        )

    @checked
    def fit(
        self,
        quantity: Quantity | str,
        name: str | None = None,
        *,
        variables: Mapping[str, ca.SX] | None = None,
        polynomial: Polynomial | None = None,
        collect: Variable | None = None,
        equation: str | None = None,
    ) -> ca.SX:
        """Name a curve fit: the polynomial that the table's section lists, in the variables of the quantity.

        It is called `name`, or the key in lower case. `variables` are what stands for variables of the fit, by their
        names, where that is not the state, input or quantity of the name. With `collect`, what is linear in that
        variable is a quantity of its own, the slope. `polynomial` takes the place of the table's.
        """
        spec = self._quantity(quantity)
        name = name or spec.key.lower()
        polynomial = polynomial or self.table.polynomials[spec.key]
        symbols = self.fit_symbols(variables or {})
        symbols |= {variable: self.seen(variable, symbols.get(variable)) for variable in spec.variables}
        if collect is None or not (slope := polynomial.linear_part(collect.name)).terms:
            expr = polynomial.expression(symbols)
        else:
            base, _, index = spec.symbol.partition("_")
            per_variable = self.define(
                f"{name}_{collect.name}",
                slope.expression(symbols),
                f"{base}_{{{index},{collect.symbol}}}" if index else f"{base}_{collect.symbol}",
                units.quotient(spec.unit, collect.unit),
                f"slope of the {spec.doc} in the {collect.doc}",
                equation=equation,
            )
            rest = polynomial.without_linear(collect.name).expression(symbols)
            expr = per_variable * symbols[collect.name] + rest
        return self.define(name, expr, spec.symbol, spec.unit, spec.doc, equation=equation)

    @checked
    def seen(self, named: Named, value: ca.SX | None = None) -> ca.SX:
        """A state as curve fits see it: with what parts add to it, such as the incidence of a gust.

        A derived variable of curve fits is written in it. Without such a part it is the state itself, or `value` in
        its place.
        """
        return self[named] if value is None else value

    def fit_symbols(self, variables: Mapping[str, ca.SX]) -> dict[str, ca.SX]:
        """What a polynomial is written in: quantities and coefficients by name, and the given variables."""
        quantities = {name: self.graph.symbols[name] for name in self.graph.quantities}
        return quantities | self.parameters | dict(variables)

    def _quantity(self, quantity: Quantity | str) -> Quantity:
        key = quantity if isinstance(quantity, str) else quantity.key
        declared = {one.key: one for one in self.table.schema.quantities}
        if key not in declared:
            raise FamilyError(f"no table of `{self.name}` has the quantity `{key}`", suggestion(key, declared))
        return declared[key]

    @checked
    def derivative(self, expr: ca.SX, named: Named | Parameter) -> ca.SX:
        """The total derivative of an expression with respect to a state, an input or a parameter."""
        name = name_of(named)
        for known in (f"x.{name}", f"u.{name}", f"p.{name}"):
            if known in self.graph.symbols:
                return self.graph.derivative(expr, known)
        raise FamilyError(f"`{name}` is not a state, an input or a parameter of `{self.name}`")

    # What the model is

    @checked
    def motion(self, rates: Rates, equation: str | None = None) -> None:
        """The equations of motion: the time derivative of every state; with them their first and second derivatives.

        Raises:
            FamilyError: when a rate is missing, or is of something that is not a state.
            ExpressionError: when a rate has not the unit of its state per second.
        """
        self._once("model.motion")
        named = {name_of(state): ca.SX(rate) for state, rate in rates.items()}
        states = self.names("state")
        self._refuse_unknown("states", named, states)
        missing = [state for state in states if state not in named]
        if missing:
            raise FamilyError(f"the rate of {_listed(missing)} is missing in `{self.name}`")
        for state in states:
            self.graph.check(f"the rate of `{state}`", named[state], units.quotient(self.unit(state), "s"))
        self.rates = {state: named[state] for state in states}
        motion.add_drift_and_derivatives(self, self.rates, self._equation if equation is None else equation)

    @checked
    def diffusion(self, gains: Gains, doc: str, equation: str | None = None) -> None:
        """The diffusion G of dx = f dt + G dW, by (state, Wiener increment), read in the Itô sense.

        Whether its columns are constant, diagonal or general, and which pairs commute, is found from it. `doc` is a
        remark on the columns.
        """
        if self.rates is None:
            raise FamilyError("the diffusion follows the equations of motion: call `model.motion(...)` first")
        self._once("model.diffusion")
        named = {(name_of(row), name_of(column)): ca.SX(gain) for (row, column), gain in gains.items()}
        rows, columns = self.names("state"), self.names("noise") if "noise" in self.bases else ()
        self._refuse_unknown("states", dict.fromkeys(row for row, _ in named), rows)
        self._refuse_unknown("Wiener increments", dict.fromkeys(column for _, column in named), columns)
        idle = [column for column in columns if column not in [name for _, name in named]]
        if idle:
            raise FamilyError(f"the Wiener increment `{idle[0]}` of `{self.name}` has no gain: it would drive nothing")
        for (row, column), gain in named.items():
            unit = units.quotient(self.unit(row), self.unit(column))
            self.graph.check(f"the gain of `{column}` in the rate of `{row}`", gain, unit)
        equation = self._equation if equation is None else equation
        self.noise_structure = stochastic.add_diffusion(self, self.rates, named, doc, equation)

    @checked
    def outputs(self, *named: Named) -> None:
        """Quantities that commands print and reports show beside the states, as one function and one vector."""
        self._once("model.outputs")
        quantities = [self._defined(one) for one in named if name_of(one) not in self.names("state")]
        self._refuse_unknown("outputs", (q.name for q in quantities), self.graph.quantities)
        stated = [self._units.get(q.name, q.unit) for q in quantities]
        self.bases["output"] = tuple(
            Variable(q.name, q.symbol, unit, q.doc) for q, unit in zip(quantities, stated, strict=True)
        )
        entries = tuple(Entry((q.name,), self.graph.symbols[q.name]) for q in quantities)
        doc = "Quantities that people look at, which are not states"
        self.add("outputs", "outputs", doc, "", [Output("", ("output",), entries)])

    def check(self) -> None:
        """Raise `FamilyError` when something is missing, or shown that there is not."""
        if self.rates is None:
            raise FamilyError(
                f"the model `{self.name}` has no equations of motion; state them with `model.motion(...)`"
            )
        if "noise" in self.bases and self.noise_structure is None:
            raise FamilyError(
                f"the model `{self.name}` has the noise {_listed(list(self.names('noise')))}, but no diffusion",
                "state it with `model.diffusion(...)`, or leave out `noise=`",
            )
        if not self.bases.get("output"):
            raise FamilyError(f"`{self.name}` has no outputs; state them with `model.outputs(...)`")
        known = [name for basis in ("state", "input", "output") for name in self.names(basis)]
        self._refuse_unknown("states, inputs and outputs that a trim shows", self.traits.trim.shown, known)

    @checked
    def evaluations(self, *named: Named) -> None:
        """Quantities that have a function each, for callers that need one alone."""
        for one in named:
            quantity = self._defined(one)
            doc = quantity.doc[0].upper() + quantity.doc[1:]
            expr = self.graph.symbols[quantity.name]
            self.add_scalar(quantity.name, "evaluations", doc, quantity.equation, expr, quantity.unit)

    @checked
    def trim(
        self,
        *,
        given: Iterable[Given] = (),
        sought: Iterable[Sought],
        equations: Iterable[Equation],
        moving: Iterable[Named] = (),
        shown: Iterable[Named] = (),
    ) -> None:
        """The trim problem: unknowns are `sought` so that the `equations`, rows of the drift and outputs, vanish.

        States and outputs may be `given`; an output that is given is an equation more. States that are neither given
        nor sought are 0, inputs that are not sought are held. `moving` are states whose rate need not vanish, such as
        the altitude; `shown` are states, inputs and outputs that a trim prints. The outputs are stated before.

        Raises:
            FamilyError: when there are not as many equations as unknowns, or a name fits nothing.
        """
        self._once("model.trim")
        trim = Trim(tuple(given), tuple(sought), tuple(equations), *(tuple(map(name_of, n)) for n in (moving, shown)))
        rows, unknowns = [row.name for row in trim.equations], [one.name for one in trim.sought]
        states, givens = self.names("state"), [one.name for one in trim.given]
        given_states = [name for name in givens if name in states]
        known = (*states, *(output.name for output in self.bases.get("output", ())))
        likes = [equation.like_names for equation in trim.equations if equation.like_names]
        self._refuse_unknown("states and outputs that a trim is given", givens, known)
        self._refuse_unknown("unknowns of the trim", unknowns, (*states, *self.names("input")))
        rows += [name for name in givens if name not in states]
        self._refuse_unknown("equations of the trim", rows, known)
        self._refuse_unknown("states that move in the trim", trim.moving, states)
        self._refuse_unknown("rows that others are like", dict.fromkeys(row for row, _ in likes), rows)
        self._refuse_unknown("values that others are like", dict.fromkeys(state for _, state in likes), given_states)
        if len(rows) != len(unknowns):
            raise FamilyError(
                f"the trim of `{self.name}` has {len(rows)} equations ({', '.join(rows)}) for {len(unknowns)} unknowns"
                f" ({', '.join(unknowns)})"
            )
        both = [name for name in givens if name in unknowns]
        if both:
            raise FamilyError(f"{_listed(both)} is given and sought in the trim of `{self.name}`")
        self.traits.trim = trim

    @checked
    def mode(self, name: str, *states: Named, slowest: str | None = None) -> None:
        """Name the poles of some states; of an odd number of real poles the slowest may have a name of its own."""
        check_texts(name)
        mode = Mode(name, tuple(map(name_of, states)), slowest)
        of_others = [state for other in self.traits.modes for state in other.states]
        self._refuse_unknown("states of modes", (*of_others, *mode.states), self.names("state"))
        self.traits.modes += (mode,)

    @checked
    def defaults(self, *, inputs: Iterable[Named] = (), outputs: Iterable[Named] = ()) -> None:
        """The inputs and the states that a transfer function is of, if a command names none."""
        self._once("model.defaults")
        self.traits.inputs, self.traits.outputs = tuple(map(name_of, inputs)), tuple(map(name_of, outputs))
        self._refuse_unknown("default inputs", self.traits.inputs, self.names("input"))
        self._refuse_unknown("default outputs", self.traits.outputs, self.names("state"))

    @checked
    def deviations(self, deviations: Mapping[Variable, float] | Mapping[str, float]) -> None:
        """The deviations of states and inputs that cost 1 in a regulator, in the units of the variables."""
        self._once("model.deviations")
        self.traits.deviations = {name_of(variable): size for variable, size in deviations.items()}
        known = (*self.names("state"), *self.names("input"))
        self._refuse_unknown("deviations", self.traits.deviations, known)
        for name, size in self.traits.deviations.items():
            if not 0 < size < math.inf:
                raise FamilyError(f"the deviation of `{name}` is {size!r}; it must be positive and finite")

    @checked
    def note(self, text: str) -> None:
        """A warning that commands print before they use the model."""
        self._once("model.note")
        check_texts(text)
        self.traits.note = text

    def _refuse_unknown(self, what: str, stated: Iterable[str], known: Iterable[str]) -> None:
        stated, known = tuple(stated), tuple(known)
        for position, name in enumerate(stated):
            if name not in known:
                raise FamilyError(f"{what} of `{self.name}`: there is no `{name}`", suggestion(name, known))
            if name in stated[:position]:
                raise FamilyError(f"{what} of `{self.name}`: `{name}` is used twice")

    def _defined(self, named: Named) -> Intermediate:
        name = name_of(named)
        if name not in self.graph.quantities:
            help_line = suggestion(name, self.graph.quantities)
            raise FamilyError(f"`{name}` is not a quantity that `{self.name}` has defined", help_line)
        return self.graph.quantities[name]


def _listed(stated: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in stated)
