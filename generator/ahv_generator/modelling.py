"""Everything that the file of a family imports. `docs/families.md` shows each part of it in use.

A family states what a vehicle is: its variables, the parameters and curve fits of its tables, the equations of its
models, its trim problem, its modes. It is one Python file with a variable `family`, beside the table that names it
(`[table] family = "oscillator.py"`):

    from ahv_generator.modelling import POSITIVE, Equation, Family, Given, Model, Parameter, Quantity, Sought, Variable

    position = Variable("position", "x", "ft", "displacement")
    rate = Variable("rate", "v", "ft/s", "rate of the displacement")
    force = Variable("force", "F", "lb", "force on the mass")
    mass = Parameter("m", "m", "slug", "mass", POSITIVE)
    spring = Quantity("F_S", "F_S", "lb", "force of the spring", depends_on=(position,))

    family = Family()
    family.bounds(position, rate, force)
    family.parameters("oscillator", mass)
    family.quantities(spring)

    @family.model("oscillator", "a mass on a spring", states=(position, rate), inputs=(force,))
    def oscillator(model: Model) -> None:
        with model.section("Spring", "(1)"):
            pull = model.fit(spring)
            potential = model.define("potential", model[position] * pull / 2, "U", "ft*lb", "energy of the spring")
        model.motion({position: model[rate], rate: (model[force] - pull) / model[mass]}, "(1)")
        model.outputs("potential")
        model.trim(given=[Given(position, 0.0)], sought=[Sought(force)], equations=[Equation(rate)])

Units are products of powers of `ft slug lb s rad deg K` or `m kg N s rad deg K` (`slug*ft^2`, `(ft*slug)^0.5/s`),
`1` for a pure number; a family may state its units in either system, a table its values in the one that it names.
Expressions are CasADi scalars. Their dimensions are checked where they are named, and a fault is reported with file and
line.
"""

from __future__ import annotations

from .atmosphere import EXPONENTIAL, US_1976, Air, exponential_density, us_standard_atmosphere_1976
from .diagnostics import FamilyError
from .elementary import (
    Expr,
    acos,
    asin,
    atan,
    atan2,
    cos,
    cosh,
    exp,
    fmax,
    fmin,
    log,
    select,
    sin,
    sinh,
    sqrt,
    tan,
    tanh,
)
from .family import Family, Outline
from .function import Entry, Output
from .model import Gains, Model, Rates
from .part import Input, Join, Part, PartModel, State
from .schema import (
    NOT_NEGATIVE,
    NOT_ZERO,
    POSITIVE,
    Choice,
    Option,
    Parameter,
    Quantity,
    Rule,
    Variable,
    switch,
)
from .traits import Equation, Given, Sought

__all__ = [
    "EXPONENTIAL",
    "NOT_NEGATIVE",
    "NOT_ZERO",
    "POSITIVE",
    "US_1976",
    "Air",
    "Choice",
    "Entry",
    "Equation",
    "Expr",
    "Family",
    "FamilyError",
    "Gains",
    "Given",
    "Input",
    "Join",
    "Model",
    "Option",
    "Outline",
    "Output",
    "Parameter",
    "Part",
    "PartModel",
    "Quantity",
    "Rates",
    "Rule",
    "Sought",
    "State",
    "Variable",
    "acos",
    "asin",
    "atan",
    "atan2",
    "cos",
    "cosh",
    "exp",
    "exponential_density",
    "fmax",
    "fmin",
    "log",
    "select",
    "sin",
    "sinh",
    "sqrt",
    "switch",
    "tan",
    "tanh",
    "us_standard_atmosphere_1976",
]
