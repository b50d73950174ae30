"""Steps of the schemes that CasADi's users write or have: one step, or the whole loop of a flight."""

from __future__ import annotations

import casadi as ca

from expansion import Expansion

OPTIONS = {"cse": True}
# Numbers of steps of the whole loops, around the errors of interest; each is a function of its own, long to compile.
LOOPS = (16, 32, 64, 128, 1024, 2048, 4096, 8192)


def runge_kutta(name: str, expansion: Expansion) -> ca.Function:
    """One step of the classical Runge-Kutta method: state, input, parameters, step size."""
    arguments = [expansion.leaves("state"), expansion.leaves("input"), expansion.parameters()]
    drift = ca.Function("drift", arguments, [expansion.drift()])
    x, u, p = arguments
    h = ca.SX.sym("h")
    k1 = drift(x, u, p)
    k2 = drift(x + h / 2 * k1, u, p)
    k3 = drift(x + h / 2 * k2, u, p)
    k4 = drift(x + h * k3, u, p)
    return ca.Function(name, [x, u, p, h], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)], OPTIONS)


def euler_maruyama(name: str, expansion: Expansion) -> ca.Function:
    """One step of the Euler-Maruyama method: state, input, parameters, step size, Wiener increments."""
    x, u, p = expansion.leaves("state"), expansion.leaves("input"), expansion.parameters()
    h, dw = ca.SX.sym("h"), expansion.leaves("noise")
    after = x + h * expansion.drift() + ca.densify(expansion.diffusion() @ dw)
    return ca.Function(name, [x, u, p, h, dw], [after], OPTIONS)


def equation(expansion: Expansion, scales: list[float] | None = None) -> dict[str, ca.SX]:
    """The flight as CasADi's integrators want it, with input and parameters in one; in units of `scales`."""
    state, drift = expansion.leaves("state"), expansion.drift()
    if scales is not None:
        units = ca.DM(scales)
        drift = ca.substitute(drift, state, state * units) / units
    return {"x": state, "p": ca.vertcat(expansion.leaves("input"), expansion.parameters()), "ode": drift}


def loop(name: str, expansion: Expansion, steps: int, end: float) -> ca.Function:
    """CasADi's integrator `rk` over the whole flight: state, input with parameters."""
    options = {"number_of_finite_elements": steps, "simplify": True}
    problem = equation(expansion)
    integrator = ca.integrator(f"{name}_integrator", "rk", problem, 0.0, end, options)
    x, p = ca.MX.sym("x", *problem["x"].shape), ca.MX.sym("p", *problem["p"].shape)
    return ca.Function(name, [x, p], [integrator(x0=x, p=p)["xf"]])


def steps(expansion: Expansion, end: float | None) -> list[ca.Function]:
    """The functions for a model, with whole loops if there is an end."""
    name = expansion.model.name
    if name == "dcom":
        loops = [] if end is None else [loop(f"{name}_rk_{count}", expansion, count, end) for count in LOOPS]
        return [runge_kutta(f"{name}_runge_kutta", expansion), *loops]
    if name == "sdcom":
        return [
            runge_kutta(f"{name}_runge_kutta", expansion),
            euler_maruyama(f"{name}_euler_maruyama", expansion),
        ]
    if name == "sdcom_gust":
        return [euler_maruyama(f"{name}_euler_maruyama", expansion)]
    return []
