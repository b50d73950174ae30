"""Expressions as LaTeX, in the order in which their text stands, broken into lines where they are long."""

from __future__ import annotations

import ast
import re

from . import symbols
from .terms import Term, parse, product

_WIDTH = 56  # visible characters of a line before it is broken
_GROUP = r"\{([^{}]*(?:\{[^{}]*\}[^{}]*)*)\}"
_FRACTION = re.compile(rf"\\frac{_GROUP}{_GROUP}")
_FUNCTIONS = {"sin": r"\sin", "cos": r"\cos", "sinh": r"\sinh", "cosh": r"\cosh"}


def expression(text: str, mode: str = "i") -> str:
    """The LaTeX of an expression on one line."""
    return _Printer(mode).flat(parse(text))


def name(text: str, mode: str = "i") -> str:
    """The LaTeX of a name."""
    return symbols.latex(text, mode)


def term(of: Term, mode: str = "i") -> str:
    """The LaTeX of a term, with its sign, with nothing cancelled."""
    above = of.above or ("1",)
    if not of.shared:
        text = product(of)
    else:
        below = "*".join(of.below)
        text = "*".join(above) + (f"/({below})" if below else "")
    return expression(f"-({text})" if of.number < 0 else text, mode)


def equation(left: str, right: str, mode: str = "i", relation: str = "=") -> str:
    """The LaTeX of an equation, in an `aligned` block where it is too long for a line."""
    printer = _Printer(mode)
    head = printer.flat(parse(left))
    flat = printer.flat(parse(right))
    if visible(head) + visible(flat) <= _WIDTH:
        return f"{head} {relation} {flat}"
    lines = [""]
    for piece in printer.pieces(parse(right)):
        before = visible(lines[-1]) + (visible(head) if len(lines) == 1 else 0)
        if lines[-1] and before + visible(piece) > _WIDTH:
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + piece
    body = " \\\\\n&\\quad ".join(lines)
    return f"\\begin{{aligned}}\n{head} &{relation} {body}\n\\end{{aligned}}"


def visible(text: str) -> int:
    """About as many characters as a reader sees; the longer part of a fraction counts for both."""
    while (found := _FRACTION.search(text)) is not None:
        text = text.replace(found[0], max(found[1], found[2], key=_plain_length))
    return _plain_length(text)


def _plain_length(text: str) -> int:
    text = re.sub(r"\\(?:Bigl|Bigr|bigl|bigr|left|right|mathbf|bar|hat|dot|ddot|quad)", "", text)
    text = re.sub(r"\\(sin|cos|sinh|cosh)(?![a-z])", r"\1", text)
    return len(re.sub(r"[{}^_\s]", "", re.sub(r"\\[a-zA-Z]+", "x", text)))


class _Printer:
    """Prints syntax trees with the index of one flexible mode."""

    def __init__(self, mode: str) -> None:
        self.mode = mode

    def flat(self, node: ast.expr) -> str:
        """The LaTeX of a tree on one line."""
        minus, node = _without_minus(node)
        return "-" + self._factor(node) if minus else self._flat(node)

    def _flat(self, node: ast.expr) -> str:
        match node:
            case ast.Constant(value=value):
                return str(value)
            case ast.Name(id=identifier):
                return symbols.latex(identifier, self.mode)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return f"{self.flat(left)} + {self.flat(right)}"
            case ast.BinOp(left=left, op=ast.Sub(), right=right):
                return f"{self.flat(left)} - {self._factor(right)}"
            case ast.BinOp(left=left, op=ast.Mult(), right=right):
                return f"{self._factor(left)} {self._factor(right)}"
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return self._fraction(left, right)
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return f"{self._base(left)}^{{{self.flat(right)}}}"
            case ast.Call(func=ast.Name(id=function), args=[inner]):
                return self._call(function, inner)
        raise ValueError(f"the audit has no LaTeX for `{ast.unparse(node)}`")

    def pieces(self, node: ast.expr, depth: int = 0) -> list[str]:
        """The LaTeX of a tree as pieces between which a line may be broken."""
        minus, node = _without_minus(node)
        found = self._pieces(node, depth)
        return ["-" + found[0], *found[1:]] if minus else found

    def _pieces(self, node: ast.expr, depth: int) -> list[str]:
        match node:
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                inner = self.pieces(right, depth)
                return [*self.pieces(left, depth), "+ " + inner[0], *inner[1:]]
            case ast.BinOp(left=left, op=ast.Sub(), right=right):
                inner = [self._enclosed(right)] if _is_sum(right) else self.pieces(right, depth)
                return [*self.pieces(left, depth), "- " + inner[0], *inner[1:]]
            case ast.BinOp(left=left, op=ast.Mult(), right=ast.Call(func=ast.Name(id="modes"), args=[inner])):
                return self._bracketed(rf"{self._factor(left)} \sum_{{{self.mode}=1}}^{{3}} ", inner, "", depth)
            case ast.BinOp(left=left, op=ast.Mult(), right=right) if _is_sum(right):
                return self._bracketed(self._factor(left) + " ", right, "", depth)
            case ast.BinOp(left=left, op=ast.Mult(), right=right) if _is_sum(left):
                return self._bracketed("", left, f" {self._factor(right)}", depth)
        return [self.flat(node)]

    def _bracketed(self, head: str, inner: ast.expr, tail: str, depth: int) -> list[str]:
        opening, closing = (r"\Bigl[", r"\Bigr]") if depth == 0 else (r"\bigl(", r"\bigr)")
        found = self.pieces(inner, depth + 1)
        found[0] = head + opening + found[0]
        found[-1] += closing + tail
        return found

    def _factor(self, node: ast.expr) -> str:
        return self._enclosed(node) if _is_sum(node) or isinstance(node, ast.UnaryOp) else self.flat(node)

    def _base(self, node: ast.expr) -> str:
        text = self.flat(node)
        return text if isinstance(node, ast.Name | ast.Constant) and "^" not in text else self._enclosed(node)

    def _enclosed(self, node: ast.expr) -> str:
        return rf"\left({self.flat(node)}\right)"

    def _fraction(self, above: ast.expr, below: ast.expr) -> str:
        return rf"\frac{{{self.flat(above)}}}{{{self.flat(below)}}}"

    def _call(self, function: str, inner: ast.expr) -> str:
        text = self.flat(inner)
        if function in _FUNCTIONS:
            argument = text if text.startswith("\\") and isinstance(inner, ast.Name) else self._enclosed(inner)
            return _FUNCTIONS[function] + argument
        if function == "exp":
            return f"e^{{{text}}}"
        if function == "sqrt":
            return rf"\sqrt{{{text}}}"
        if function == "integral":
            return rf"\int_0^t {text}\,d\tau"
        if function == "inverse_laplace":
            return rf"\mathcal L^{{-1}}\Bigl[{text}\Bigr]"
        if function == "modes":
            return rf"\sum_{{{self.mode}=1}}^{{3}} \left[{text}\right]"
        if function.startswith("transition_"):
            return symbols.latex(function).replace("t}", rf"({text})}}")
        return rf"{symbols.latex(function)}({text})"


def _without_minus(node: ast.expr) -> tuple[bool, ast.expr]:
    """A product whose first factor is negated is negated as a whole."""
    if isinstance(node, ast.UnaryOp):
        return True, node.operand
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
        minus, left = _without_minus(node.left)
        return minus, ast.BinOp(left, node.op, node.right)
    return False, node


def _is_sum(node: ast.expr) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)
