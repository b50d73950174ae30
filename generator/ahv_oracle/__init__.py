"""Independent 50-digit reference for the ahv models, derived with SymPy and evaluated with mpmath.

Shares nothing with ``ahv_generator`` but the coefficient tables.
"""

from .evaluate import Evaluation, Oracle
from .model import MODELS
from .program import Number
from .sampling import Point, sample
from .table import Table, TableError, load_table
from .vectors import write_vectors

__all__ = [
    "MODELS",
    "Evaluation",
    "Number",
    "Oracle",
    "Point",
    "Table",
    "TableError",
    "load_table",
    "sample",
    "write_vectors",
]
