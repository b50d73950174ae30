"""All functions of a model, with their labelled entries."""

from dataclasses import dataclass, field

from sympy import Expr

from .derivatives import Entries, drift, hessian, jacobians, lie_derivatives, parameter_jacobian
from .feedback import strict_feedback
from .flexible_mode import flexible_mode_functions, regime_functions
from .model import Model
from .stochastic import stochastic_functions


@dataclass(frozen=True)
class Functions:
    """Entries by function; and by function, where it has no value everywhere, what must be positive there."""

    entries: dict[str, Entries]
    positive: dict[str, Expr] = field(default_factory=dict)


def all_functions(model: Model) -> Functions:
    """Every function of `model`."""
    functions = {
        "drift": drift(model),
        "jacobians": jacobians(model),
        "parameter_jacobian": parameter_jacobian(model),
        "hessian": hessian(model),
    }
    if model.noises:
        functions |= stochastic_functions(model)
    if model.name == "flexible_mode":
        by_regime, positive = regime_functions(model)
        return Functions(functions | flexible_mode_functions(model) | by_regime, positive)
    functions |= lie_derivatives(model)
    if model.name in ("sdcom", "sdcom_printed"):
        functions |= strict_feedback(model)
    return Functions(functions | {name: [(name, expr)] for name, expr in model.quantities.items()})
