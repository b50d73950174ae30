"""Command line: ``python -m ahv_oracle vectors --table T --model M --points N --seed S --out F``.

``python -m ahv_oracle flights --table T --out F`` writes SciPy's flights, ``python -m ahv_oracle riccati --out F`` its
solutions of Riccati equations, ``python -m ahv_oracle roots --tables D --out F`` its trims, poles and zeros,
``python -m ahv_oracle elementary --out F`` values of sine, cosine and exponential, ``transcendental`` those of tangent,
logarithm, powers and inverses, ``python -m ahv_oracle normals --out F`` keyed normal numbers,
``python -m ahv_oracle zeros --tables D --out F`` SLICOT's invariant zeros (see there),
``python -m ahv_oracle answers --tables ../examples --out F`` what the programs of the examples must answer.
``python -m ahv_oracle identify --out F`` SciPy's estimates from a record,
``reduction`` SLICOT's reductions (see there),
``gas_dynamics`` and ``fpm`` those of the first-principles model, ``least_squares`` and
``fit_samples`` those of fits.
``--functions NAME,NAME`` restricts the outputs, so that a model with many can be written with few points.
"""

import argparse
import sys
from pathlib import Path

from .answers import answer_lines
from .elementary import elementary_lines
from .evaluate import Oracle
from .first_principles import first_principles_lines
from .fit_samples import fit_sample_lines
from .flights import flight_lines
from .gas_dynamics import gas_dynamics_lines
from .identify import identify_lines
from .least_squares import least_squares_lines
from .model import MODELS
from .normals import normal_lines
from .reduction import reduction_lines
from .riccati import riccati_lines
from .roots import root_lines
from .table import TableError
from .transcendental import transcendental_lines
from .vectors import write_lines, write_vectors
from .zeros import zero_lines

ALONE = {
    "identify": (identify_lines, "estimates of output error"),
    "reduction": (reduction_lines, "reductions of linear systems (SLICOT's: see there)"),
    "riccati": (riccati_lines, "solutions of Riccati equations"),
    "elementary": (elementary_lines, "values of sine, cosine and exponential"),
    "transcendental": (transcendental_lines, "values of tangent, logarithm, powers and inverses"),
    "normals": (normal_lines, "keyed normal numbers"),
    "gas_dynamics": (gas_dynamics_lines, "shocks, expansions, heat addition and ducts"),
    "least_squares": (least_squares_lines, "values of least squares"),
    "fit_samples": (fit_sample_lines, "coefficients from geometry"),
    "fpm": (first_principles_lines, "loads of the first-principles model"),
}
"""What takes no table: its lines, and what they are."""

OF_TABLES = {
    "roots": (root_lines, "trims, poles and zeros"),
    "zeros": (zero_lines, "invariant zeros"),
    "answers": (answer_lines, "answers of the examples' programs"),
}
"""What takes all tables: its lines, and what they are."""


def main(arguments: list[str] | None = None) -> int:
    """Run the command; return the exit status."""
    parser = argparse.ArgumentParser(prog="ahv_oracle", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    vectors = commands.add_parser("vectors", help="write reference vectors")
    vectors.add_argument("--table", type=Path, required=True, help="coefficient table (TOML)")
    vectors.add_argument("--model", choices=MODELS, required=True)
    vectors.add_argument("--points", type=int, required=True, help="number of sample points")
    vectors.add_argument("--seed", type=int, required=True)
    vectors.add_argument("--out", type=Path, required=True, help="file to write")
    vectors.add_argument("--functions", type=lambda text: text.split(","), help="comma-separated names (default: all)")
    flights = commands.add_parser("flights", help="write reference flights")
    flights.add_argument("--table", type=Path, required=True, help="coefficient table (TOML)")
    flights.add_argument("--out", type=Path, required=True, help="file to write")
    for name, (_, what) in ALONE.items():
        alone = commands.add_parser(name, help=f"write reference {what}")
        alone.add_argument("--out", type=Path, required=True, help="file to write")
    for name, (_, what) in OF_TABLES.items():
        of_tables = commands.add_parser(name, help=f"write reference {what}")
        of_tables.add_argument("--tables", type=Path, required=True, help="folder of the tables, or of the examples")
        of_tables.add_argument("--out", type=Path, required=True, help="file to write")
    options = parser.parse_args(arguments)
    if options.command in ALONE:
        lines, _ = ALONE[options.command]
        write_lines(lines(), options.out)
        return 0
    if options.command in OF_TABLES:
        of_all, _ = OF_TABLES[options.command]
        write_lines(of_all(options.tables), options.out)
        return 0
    try:
        if options.command == "flights":
            write_lines(flight_lines(options.table), options.out)
            return 0
        oracle = Oracle(options.table, options.model, options.functions)
        write_vectors(oracle, options.points, options.seed, options.out)
    except (OSError, ValueError) as error:
        kind = "" if isinstance(error, (TableError, OSError)) else f"{type(error).__name__}: "
        print(f"ahv_oracle: {options.table}: {kind}{error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
