"""Named intermediate expressions, and derivatives by the chain rule over the names."""

import sympy
from sympy import Expr, Symbol


def symbol(kind: str, name: str) -> Symbol:
    """Return the symbol of a state, input, noise, parameter or argument."""
    return Symbol(f"{kind}_{name}", real=True)


class Names:
    """Definitions of intermediate symbols, each in terms of a model's own symbols and of earlier ones.

    A name changes neither a value nor its K: both are those of the expression that the name stands for.
    """

    def __init__(self) -> None:
        """Start with no names."""
        self.definitions: dict[Symbol, Expr] = {}
        self._known: dict[Expr, Symbol] = {}
        self._leaves: dict[Symbol, frozenset[Symbol]] = {}
        self._partials: dict[tuple[Expr, Symbol], Expr] = {}
        self._slopes: dict[tuple[Symbol, Symbol], Expr] = {}

    def name(self, label: str, expr: Expr) -> Expr:
        """Return a symbol that stands for `expr`, or `expr` itself where it is a number or a symbol."""
        if expr.is_Atom:
            return expr
        if expr not in self._known:
            chosen = Symbol(f"name_{label}_{len(self.definitions)}", real=True)
            self.definitions[chosen] = expr
            self._known[expr] = chosen
            self._leaves[chosen] = self.leaves(expr)
        return self._known[expr]

    def leaves(self, expr: Expr) -> frozenset[Symbol]:
        """Return the model's own symbols on which `expr` depends."""
        parts = (self._leaves.get(part, frozenset({part})) for part in expr.free_symbols)
        return frozenset().union(*parts)

    def derivative(self, expr: Expr, variable: Symbol) -> Expr:
        """Differentiate `expr` by one of the model's own symbols; 0 where no path leads to it."""
        terms = []
        for part in sorted(expr.free_symbols, key=lambda free: str(free.name)):
            inner = self._slope(part, variable)
            if inner != 0:
                terms.append(self._partial(expr, part) * inner)
        return sympy.Add(*terms)

    def _partial(self, expr: Expr, part: Symbol) -> Expr:
        if (expr, part) not in self._partials:
            self._partials[expr, part] = sympy.diff(expr, part)
        return self._partials[expr, part]

    def _slope(self, part: Symbol, variable: Symbol) -> Expr:
        if part == variable:
            return sympy.Integer(1)
        if variable not in self._leaves.get(part, frozenset()):
            return sympy.Integer(0)
        if (part, variable) not in self._slopes:
            slope = self.derivative(self.definitions[part], variable)
            self._slopes[part, variable] = self.name("slope", slope)
        return self._slopes[part, variable]
