"""What (1)-(4), (18) and (25) imply, by SymPy, for each printed equation that follows from them.

A derived expression comes as parts: where it came from (`direct`; by differentiating sin α and cos α; through N_i;
as a column of G) and its text. The premises are read from the printed data, so nothing is entered twice.
"""

from __future__ import annotations

import ast
import functools
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import sympy

from .printed import Printed
from .terms import parse

Expr: TypeAlias = Any  # a SymPy expression; SymPy carries no types
Key = tuple[str, str]


@dataclass(frozen=True)
class Part:
    """A part of a derived expression and where it came from."""

    origin: str  # `direct`, `trigonometric`, `force` or `noise`
    text: str


Derived = dict[Key, tuple[Part, ...]]

_FUNCTIONS = {"sin": sympy.sin, "cos": sympy.cos, "sinh": sympy.sinh, "cosh": sympy.cosh}
_FUNCTIONS |= {"exp": sympy.exp, "sqrt": sympy.sqrt}
_OPERATORS: dict[type[ast.operator], Callable[[Expr, Expr], Expr]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
# The paper treats sin α and cos α as constants: they are symbols of their own, printed like the calls.
_SIN, _COS = sympy.Symbol("sin(alpha)"), sympy.Symbol("cos(alpha)")


def symbol(name: str) -> Expr:
    """The symbol of a name."""
    return sympy.Symbol(name)


def read(text: str) -> Expr:
    """An expression as SymPy has it."""
    return _read(parse(text))


def _read(node: ast.expr) -> Expr:
    match node:
        case ast.Constant(value=int(number)):
            return sympy.Integer(number)
        case ast.Name(id=name):
            return symbol(name)
        case ast.UnaryOp(operand=inner):
            return -_read(inner)
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATORS[type(op)](_read(left), _read(right))
        case ast.Call(func=ast.Name(id="modes"), args=[inner]):
            return _read(inner)
        case ast.Call(func=ast.Name(id=function), args=[inner]) if function in _FUNCTIONS:
            return _FUNCTIONS[function](_read(inner))
        case ast.Call():
            return symbol(ast.unparse(node))
    raise ValueError(f"the audit cannot read `{ast.unparse(node)}`")


def _text(expr: Expr) -> str:
    return str(sympy.expand(expr))


def _root(expr: Expr, unknown: Expr) -> Expr:
    """The zero of an expression that is linear in the unknown."""
    slope = expr.diff(unknown)
    if slope.has(unknown):
        raise ArithmeticError(f"{expr} is not linear in {unknown}")
    return sympy.expand(-expr.subs(unknown, 0) / slope)


def direct(expr: Expr) -> tuple[Part, ...]:
    """An expression of one part."""
    return (Part("direct", _text(expr)),)


@functools.cache
def derive(equations: tuple[Printed, ...]) -> Derived:
    """The derived right-hand side of every printed equation that is a result."""
    printed = {e.key: e for e in equations}
    rights = {key: e.right for key, e in printed.items()}
    langevin = _langevin(rights)
    (reduced,) = langevin["(24)", "d_chi"]
    before = _state_space(rights) | _response(rights) | langevin
    return before | _system(rights, reduced.text) | _strict_feedback(rights)


# ---------------------------------------------------------------- (5)-(14)


def _rows(rights: Mapping[Key, str]) -> tuple[Expr, Expr]:
    """A and B of (9): the derivatives of (7)'s derived right-hand sides."""
    rates = _first_order(rights)
    states = [symbol("x_1"), symbol("x_2")]
    matrix = sympy.Matrix([[rate.diff(x) for x in states] for rate in rates])
    return matrix, sympy.Matrix([rate.diff(symbol("n_d")) for rate in rates])


def _first_order(rights: Mapping[Key, str]) -> tuple[Expr, Expr]:
    acceleration = read(rights["(1)", "eta_ddot"])
    new = {"eta": "x_1", "eta_dot": "x_2", "n": "n_d"}
    return symbol("x_2"), acceleration.subs({symbol(old): symbol(name) for old, name in new.items()})


def _state_space(rights: Mapping[Key, str]) -> Derived:
    zeta, omega, t, s = (symbol(name) for name in ("zeta", "omega", "t", "laplace_s"))
    left = read("eta_ddot + 2*zeta*omega*eta_dot + omega**2*eta")
    force = left.subs(symbol("eta_ddot"), read(rights["(1)", "eta_ddot"]))
    found: Derived = {
        ("(5)", "mode"): direct(force),
        ("(6)", "n"): direct(read(rights["(2)", "n"]).subs(symbol("c_n_fit"), read(rights["(3)", "c_n_fit"]))),
    }
    x_1_dot, x_2_dot = _first_order(rights)
    found |= {("(7)", "x_1_dot"): direct(x_1_dot), ("(7)", "x_2_dot"): direct(x_2_dot)}
    a, b = _rows(rights)
    for i in (1, 2):
        row = [f"a_{i}{j}*x_{j}" for j in (1, 2)]
        found["(8)", f"x_{i}_dot"] = direct(read(" + ".join([*row, f"b_{i}*u"])))
        found["(9)", f"b_{i}"] = direct(b[i - 1])
    found["(9)", "u"] = direct(symbol("n_d"))
    pencil = s * sympy.eye(2) - a
    resolvent = pencil.adjugate() / sympy.expand(pencil.det())
    decay, root = sympy.exp(-zeta * omega * t), sympy.sqrt(1 - zeta**2)
    transition = transition_matrix(a)
    for i in (0, 1):
        for j in (0, 1):
            ij = f"{i + 1}{j + 1}"
            found["(9)", f"a_{ij}"] = direct(a[i, j])
            found["(12)", f"pencil_{ij}"] = direct(pencil[i, j])
            found["(12)", f"resolvent_{ij}"] = (Part("direct", str(resolvent[i, j])),)
            found["(13)", f"e_{ij}"] = direct(transition[i, j] / decay)
            found["(14)", f"transition_{ij}"] = direct(decay * symbol(f"e_{ij}"))
            same = sympy.cancel(laplace(transition[i, j], root) - resolvent[i, j]) == 0
            text = f"inverse_laplace(resolvent_{ij})" if same else str(transition[i, j])
            found["(11)", f"transition_{ij}"] = (Part("direct", text),)
    for i in (1, 2):
        found["(10)", f"x_{i}"] = (Part("direct", _convolution(pencil, resolvent, i)),)
    return found


def transition_matrix(a: Expr) -> Expr:
    """e^{At} for ζ < 1 by Cayley and Hamilton: eigenvalues −ζω ± iω_d."""
    zeta, omega, t = (symbol(name) for name in ("zeta", "omega", "t"))
    root = sympy.sqrt(1 - zeta**2)
    shifted = a + zeta * omega * sympy.eye(2)
    cosine, sine = sympy.cos(omega * root * t), sympy.sin(omega * root * t)
    inner = cosine * sympy.eye(2) + sine / (omega * root) * shifted
    return (sympy.exp(-zeta * omega * t) * inner).applyfunc(sympy.expand)


def laplace(expr: Expr, root: Expr) -> Expr:
    """Laplace transform of e^{−ζωt} times a combination of cos ω_d t and sin ω_d t, from the table."""
    zeta, omega, t, s = (symbol(name) for name in ("zeta", "omega", "t", "laplace_s"))
    cosine, sine = sympy.cos(omega * root * t), sympy.sin(omega * root * t)
    inner = sympy.expand(expr * sympy.exp(zeta * omega * t))
    shifted, damped = s + zeta * omega, omega * root
    below = sympy.expand(shifted**2 + damped**2)
    return (inner.coeff(cosine) * shifted + inner.coeff(sine) * damped) / below


def _convolution(pencil: Expr, resolvent: Expr, row: int) -> str:
    """Row of x(t): (sI − A) X = x₀ + B U solved, a product with U being a convolution in time."""
    force = [symbol("b_1") * symbol("u"), symbol("b_2") * symbol("u")]
    start = [symbol("x_10"), symbol("x_20")]
    solved = pencil.LUsolve(sympy.Matrix([x + f for x, f in zip(start, force, strict=True)]))[row - 1]
    solved = sympy.expand(sympy.expand(solved.together() * sympy.expand(pencil.det())).cancel())
    terms: list[str] = []
    for j, (x, f) in enumerate(zip(start, force, strict=True), 1):
        element = sympy.cancel(resolvent[row - 1, j - 1] * pencil.det())
        if sympy.cancel(solved.coeff(x) - element) != 0 or sympy.cancel(solved.coeff(f) - element) != 0:
            raise ArithmeticError("the Laplace transform of (8) is not the resolvent times its right-hand side")
        terms += [f"transition_{row}{j}*x_{j}0", f"integral(transition_{row}{j}(t - tau)*b_{j}*u(tau))"]
    return " + ".join(terms)


# ---------------------------------------------------------------- (15)-(26)


def step_response(force: Expr, start: tuple[Expr, Expr], rights: Mapping[Key, str]) -> tuple[Expr, Expr]:
    """The mode under a constant force, from `start`, as its steady and its decaying part.

    The steady part solves (5) at rest; what the initial values differ from it decays by e^{At} of (14). The part of
    the force is written in E_12 and the cosine, as (15) has it.
    """
    zeta, omega, t = (symbol(name) for name in ("zeta", "omega", "t"))
    eta = symbol("eta")
    at_rest = read(rights["(1)", "eta_ddot"]).subs({symbol("eta_dot"): 0, symbol("n"): force})
    steady = _root(at_rest, eta)
    a, _ = _rows(rights)
    elements = transition_matrix(a) / sympy.exp(-zeta * omega * t)
    root = sympy.sqrt(1 - zeta**2)
    cosine, sine = sympy.cos(omega * root * t), sympy.sin(omega * root * t)
    e_11 = sympy.expand(elements[0, 0])
    e_12 = sympy.expand(elements[0, 1]).coeff(sine)
    in_place = e_11.coeff(cosine) * cosine + e_11.coeff(sine) / e_12 * symbol("e_12")
    inner = start[0] * symbol("e_11") + start[1] * symbol("e_12") - steady * in_place
    return steady, sympy.expand(sympy.exp(-zeta * omega * t) * inner)


def _response(rights: Mapping[Key, str]) -> Derived:
    steady, decaying = step_response(symbol("n_d"), (symbol("eta_d_0"), symbol("eta_d_dot_0")), rights)
    noise = symbol("sigma") * symbol("c")
    steady_n, decaying_n = step_response(noise, (symbol("eta_n_0"), symbol("eta_n_dot_0")), rights)
    return {
        ("(15)", "eta_d"): direct(steady + decaying),
        ("(17)", "mode"): direct(read("sigma*xi")),
        ("(19)", "eta_n"): direct(steady_n + decaying_n),
        ("(25)", "eta_hat"): direct(steady + decaying + symbol("chi")),
    }


def _langevin(rights: Mapping[Key, str]) -> Derived:
    a, b, c, t, chi = (symbol(name) for name in ("a", "b", "c", "t", "chi"))
    increment = read(rights["(18)", "d_chi"])
    rate = sympy.expand(increment.subs({symbol("dw"): c * symbol("dt")}) / symbol("dt"))
    decay = -rate.coeff(chi)
    rest = _root(rate, chi)
    # χ(0) = 0 fixes the constant of the decaying solution.
    solution = rest - rest * sympy.exp(-decay * t)
    steady, _ = step_response(symbol("sigma") * c, (sympy.S.Zero, sympy.S.Zero), rights)
    matched_a = symbol("zeta") * symbol("omega")  # the rate of e^{At} in (14)
    matched_b = _root(rest.subs(a, matched_a) - steady, b)
    reduced = increment.subs({a: matched_a, b: matched_b})
    return {
        ("(20)", "chi"): direct(rate + a * chi),
        ("(21)", "chi"): direct(solution),
        ("(22)", "a"): direct(matched_a),
        ("(22)", "steady"): direct(steady),
        ("(23)", "a"): direct(matched_a),
        ("(23)", "b"): direct(matched_b),
        ("(24)", "d_chi"): direct(reduced),
        ("(26)", "d_chi"): direct(reduced),
    }


# ---------------------------------------------------------------- (27)-(35)

# Each row of (1) by its letter in f, g, h, H: the equation that defines them, and its name.
ROWS = {
    "V": ("(28)", "velocity_dot"),
    "gamma": ("(30)", "gamma_dot"),
    "alpha": ("(32)", "alpha_dot"),
    "Q": ("(34)", "pitch_rate_dot"),
}
_FLEXIBLE = {"V": "(29)", "gamma": "(31)", "alpha": "(33)", "Q": "(35)"}
CONTROL = {"V": "phi", "gamma": "alpha", "alpha": "pitch_rate", "Q": "delta_e"}
# What may stand before the bracket of h_*: the rest of it is h_*^i.
_PREFACTOR = ("dynamic_pressure", "s", "m", "velocity", "i_yy")


def _system(rights: Mapping[Key, str], reduced_text: str) -> Derived:
    """The rows of (27): the split by definition, and the columns of G that no function H carries."""
    # White noise is the formal rate of a Wiener process.
    reduced = read(reduced_text)
    chi_dot = sympy.expand(reduced.subs(symbol("dw"), symbol("xi") * symbol("dt")) / symbol("dt"))
    found: Derived = {("(27)", "chi_dot"): direct(chi_dot)}
    drifts = {
        name: read(f"f_{row} + g_{row}*{CONTROL[row]} + delta_f_{row} + h_{row}*chi + H_{row}*w_alpha")
        for row, (_, name) in ROWS.items()
    }
    drifts["altitude_dot"] = read(rights["(1)", "altitude_dot"])  # no part of it depends on α, χ or an input
    for name, drift in drifts.items():
        rate = read(rights["(1)", name])
        columns = rate.diff(symbol("gamma")) * symbol("w_gamma") + rate.diff(symbol("pitch_rate")) * symbol("w_q")
        found["(27)", name] = (*direct(drift), Part("noise", _text(columns)))
    return found


def substituted(row: str, rights: Mapping[Key, str]) -> Expr:
    """A row of (1) with (2), (3), (4) and (25) put in; N_i, sin α and cos α stay symbols."""
    return _substituted(row, tuple(rights.items()))


@functools.cache
def _substituted(row: str, items: tuple[tuple[Key, str], ...]) -> Expr:
    rights = dict(items)
    expr = read(rights["(1)", row])
    for number in ("(2)", "(3)"):
        for name in [n for k, n in rights if k == number and n not in ("dynamic_pressure", "n")]:
            expr = expr.subs(symbol(name), read(rights[number, name]))
        if number == "(2)":  # the moment contains the thrust
            expr = expr.subs(symbol("thrust"), read(rights["(2)", "thrust"]))
    expr = expr.subs(symbol("delta_c"), read(rights["(4)", "delta_c"]))
    reduced = read(rights["(25)", "eta_hat"]).subs(symbol("n_d"), symbol("n"))
    expr = expr.subs(symbol("eta"), reduced)
    for name in [n for k, n in rights if k == "(3)"]:
        expr = expr.subs(symbol(name), read(rights["(3)", name]))
    alpha = symbol("alpha")
    return sympy.expand(expr.subs({sympy.sin(alpha): _SIN, sympy.cos(alpha): _COS}))


def _force_slope(rights: Mapping[Key, str]) -> Expr:
    force = read(rights["(2)", "n"]).subs(symbol("c_n_fit"), read(rights["(3)", "c_n_fit"]))
    return force.diff(symbol("alpha"))


def _prefactor(expr: Expr) -> Expr:
    """The common power product of q̄, S, m, V and I_yy of all terms."""
    powers = [term.as_powers_dict() for term in sympy.Add.make_args(expr)]
    result = sympy.S.One
    for name in _PREFACTOR:
        exponents = {p.get(symbol(name), 0) for p in powers}
        if len(exponents) == 1:
            result *= symbol(name) ** exponents.pop()
    return result


def _strict_feedback(rights: Mapping[Key, str]) -> Derived:
    """f, g, h, H of the four rows, by the definitions of the split."""
    found: Derived = {}
    slope = _force_slope(rights)
    for row, (number, name) in ROWS.items():
        flexible = _FLEXIBLE[row]
        rate = substituted(name, rights)
        chi, n, alpha = symbol("chi"), symbol("n"), symbol("alpha")
        h = sympy.expand(rate.diff(chi))
        f_eta = sympy.expand(rate.coeff(n) * n)
        control = symbol(CONTROL[row])
        quiet = sympy.expand(rate.subs({chi: 0, n: 0}))
        g = quiet.coeff(control, 1)
        f = sympy.expand(quiet - g * control) + symbol(f"f_{row}_eta")
        before = _prefactor(h)
        found[number, f"f_{row}"] = direct(f)
        found[number, f"g_{row}"] = direct(g)
        found[number, f"h_{row}"] = direct(before * symbol(f"h_{row}_i"))
        found[number, f"H_{row}"] = (
            *direct(rate.diff(alpha)),
            Part("trigonometric", _text(rate.diff(_SIN) * _COS - rate.diff(_COS) * _SIN)),
            Part("force", _text(rate.diff(n) * slope)),
        )
        found[flexible, f"f_{row}_eta"] = direct(f_eta)
        found[flexible, f"h_{row}_i"] = direct(h / before)
    return found
