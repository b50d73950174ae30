"""The computed audit of the paper's printed equations: what they say beside what (1)-(4), (18) and (25) imply."""

from __future__ import annotations

from .corrected import corrected_expressions
from .report import render

__all__ = ["corrected_expressions", "render"]
