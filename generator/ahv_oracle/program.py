"""Compiles expressions to one straight-line Python function that gives values and the error measure's K.

K is the expression with every summand replaced by its absolute value, in the structure in which the
expression is written. K of a function, of a root and of a reciprocal is the absolute value of its value.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import mpmath
import sympy
from sympy import Expr, Symbol

from .table import TableError

Number = Any
"""An ``mpmath.mpf``, a float or an int (mpmath 1.3 has no types)."""

_FUNCTIONS = {sympy.sin: "sin", sympy.cos: "cos", sympy.exp: "exp"}
_SMALLEST_NORMAL = 2.0**-1022
_SLOPES = {"sin": "cos", "cos": "sin", "exp": "exp"}  # of which the size is the slope's


class Program:
    """Values (mpmath, at the digits in force) and K (floats) of some expressions."""

    def __init__(
        self,
        arguments: Sequence[Symbol],
        definitions: Mapping[Symbol, Expr],
        outputs: Sequence[Expr],
        conditioned: bool = False,
    ) -> None:
        """Compile `outputs`, written in `arguments` and `definitions`.

        With `conditioned`, K of f(x) also holds what an error of the measure's size in x does to it,
        |f(x)| + |f'(x)| K(x): for arguments that reach hundreds, as those of a mode's motion do. There
        exp(x) may be too small for a normal double; the smallest of them is added for what is lost then.
        """
        emitter = _Emitter(arguments, definitions, conditioned)
        results = [emitter.visit(output) for output in outputs]
        source = ["def evaluate(arguments):"]
        if arguments:
            source.append(f" {', '.join(f'a{i}' for i in range(len(arguments)))}, = arguments")
        source += [f" {line}" for line in emitter.lines]
        source.append(f" return [{', '.join(f'({value}, {magnitude})' for value, magnitude in results)}]")
        scope: dict[str, Any] = {"exp": mpmath.exp, "sin": mpmath.sin, "cos": mpmath.cos, "sqrt": mpmath.sqrt}
        scope["constants"] = emitter.constants
        exec(compile("\n".join(source), "<oracle>", "exec"), scope)
        self._evaluate = scope["evaluate"]

    def __call__(self, arguments: Sequence[Number]) -> list[tuple[Number, float]]:
        """Value and K of each output at `arguments`, which are ``mpf``."""
        results: list[tuple[Number, float]] = self._evaluate(arguments)
        return results


class _Emitter:
    """Writes each distinct subexpression once: a line for its value and one for its K."""

    def __init__(self, arguments: Sequence[Symbol], definitions: Mapping[Symbol, Expr], conditioned: bool) -> None:
        self.lines: list[str] = []
        self.constants: list[Number] = []
        self._definitions = definitions
        self._conditioned = conditioned
        self._seen: dict[Expr, tuple[str, str]] = {}
        for i, argument in enumerate(arguments):
            self._seen[argument] = (f"a{i}", self._line(f"abs(float(a{i}))"))

    def visit(self, expr: Expr) -> tuple[str, str]:
        """Return the texts of the value and of K of `expr`, whose lines are written."""
        if expr not in self._seen:
            self._seen[expr] = self._build(expr)
        return self._seen[expr]

    def _line(self, text: str) -> str:
        self.lines.append(f"x{len(self.lines)} = {text}")
        return f"x{len(self.lines) - 1}"

    def _build(self, expr: Expr) -> tuple[str, str]:
        if expr.is_Number:
            return self._number(expr)
        if isinstance(expr, Symbol):
            if expr not in self._definitions:
                raise TableError(f"the table has no {expr.name.replace('_', ' ', 1)}, which this model needs")
            return self.visit(self._definitions[expr])
        if isinstance(expr, (sympy.Add, sympy.Mul)):
            parts = [self.visit(arg) for arg in expr.args]
            sign = " + " if isinstance(expr, sympy.Add) else " * "
            return self._line(sign.join(value for value, _ in parts)), self._line(sign.join(k for _, k in parts))
        if isinstance(expr, sympy.Pow):
            return self._power(*expr.as_base_exp())
        if expr.func in _FUNCTIONS and len(expr.args) == 1:
            return self._function(_FUNCTIONS[expr.func], expr.args[0])
        raise ValueError(f"no K for {expr}")

    def _number(self, number: Expr) -> tuple[str, str]:
        if number.is_Integer:
            return f"({number})", f"{abs(int(number))}.0"
        if not number.is_Rational:
            raise ValueError(f"no exact value of {number}")
        with mpmath.workdps(60):
            self.constants.append(mpmath.mpf(int(number.p)) / int(number.q))
        return f"constants[{len(self.constants) - 1}]", repr(abs(float(number)))

    def _power(self, base: Expr, exponent: Expr) -> tuple[str, str]:
        if not (2 * exponent).is_Integer:
            raise ValueError(f"no K for the power {base}**{exponent}")
        value, magnitude = self.visit(base)
        if exponent.is_Integer:
            count = abs(int(exponent))
            text = f"{value}**{count}" if count > 1 else value
        else:
            root = self._line(f"sqrt({value})")
            count = abs(int(2 * exponent))
            text = f"{root}**{count}" if count > 1 else root
        if exponent.is_Integer and exponent > 0:
            return self._line(text), self._line(f"{magnitude}**{count}")
        result = self._line(text if exponent > 0 else f"1 / ({text})")
        return result, self._line(f"abs(float({result}))")

    def _function(self, name: str, argument: Expr) -> tuple[str, str]:
        value, magnitude = self.visit(argument)
        result = self._line(f"{name}({value})")
        size = f"abs(float({result}))"
        if self._conditioned:
            size += f" + {_SMALLEST_NORMAL}"
            slope = result if name == "exp" else f"{_SLOPES[name]}({value})"
            size += f" + abs(float({slope})) * {magnitude}"
        return result, self._line(size)
