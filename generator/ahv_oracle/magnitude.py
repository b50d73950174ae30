"""The error measure's K: an expression with every summand replaced by its absolute value."""

import sympy
from sympy import Expr, Symbol


class Magnitude:
    """Builds K expressions; remembers subexpressions and the absolute values of symbols."""

    def __init__(self) -> None:
        """Start with nothing seen."""
        self._seen: dict[Expr, Expr] = {}

    @staticmethod
    def absolute(symbol: Symbol) -> Symbol:
        """Return the symbol that stands for |symbol|."""
        return Symbol(f"abs_{symbol.name}", nonnegative=True)

    def of(self, expr: Expr) -> Expr:
        """K of `expr`, in the structure in which `expr` is written."""
        if expr not in self._seen:
            self._seen[expr] = self._build(expr)
        return self._seen[expr]

    def _build(self, expr: Expr) -> Expr:
        if isinstance(expr, Symbol):
            return self.absolute(expr)
        if isinstance(expr, sympy.Add):
            return sympy.Add(*(self.of(arg) for arg in expr.args))
        if isinstance(expr, sympy.Mul):
            return sympy.Mul(*(self.of(arg) for arg in expr.args))
        if isinstance(expr, sympy.Pow):
            base, exponent = expr.as_base_exp()
            if not exponent.is_Integer:
                raise ValueError(f"no K for the power {expr}")
            if exponent > 0:
                return self.of(base) ** exponent
            return (self.absolute(base) if isinstance(base, Symbol) else sympy.Abs(base)) ** exponent
        return sympy.Abs(expr)
