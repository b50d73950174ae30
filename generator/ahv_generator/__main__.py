"""Command line: `python -m ahv_generator derive --out DIR TABLE...`, `... describe TABLE` and `... evaluate`.

`describe` prints what a table may hold, which is its IR without models. `evaluate` writes CasADi's own
values of a model at points that the oracle drew.

Exit codes: 0 done, 1 it cannot be done (standard error says why), 2 a table is at fault (its diagnostics stand on
standard output as JSON).
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from . import ir, reference
from .derive import derive as derive_all
from .derive import escaped
from .diagnostics import Diagnostic, TableError
from .table import Table, load


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="ahv_generator")
    commands = parser.add_subparsers(dest="command", required=True)
    derive = commands.add_parser("derive", help="derive the models of tables and write their IR")
    derive.add_argument("--out", type=Path, required=True, help="folder for <table>.json, audit.json")
    derive.add_argument("--known", action="append", default=[], help="a table whose IR is known, and not derived again")
    derive.add_argument("--audit-known", action="store_true", help="leave audit.json empty where there is to be one")
    derive.add_argument("tables", type=Path, nargs="+")
    verify = commands.add_parser("verify", help="check the models of tables at points, and write those as vectors")
    verify.add_argument("--out", type=Path, required=True, help="folder for <model>.txt")
    verify.add_argument("--points", type=int, required=True, help="points of each model")
    verify.add_argument("tables", type=Path, nargs="+")
    describe = commands.add_parser("describe", help="print what the family says of a table, without its models")
    describe.add_argument("table", type=Path)
    evaluate = commands.add_parser("evaluate", help="evaluate a model at the points of an oracle file")
    evaluate.add_argument("--table", type=Path, required=True)
    evaluate.add_argument("--model", required=True, help="one of the models that the table lists")
    evaluate.add_argument("--points", type=Path, required=True, help="file of reference vectors")
    evaluate.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    try:
        if arguments.command == "derive":
            _derive(arguments.tables, arguments.out, arguments.known, arguments.audit_known)
        elif arguments.command == "verify":
            # Here, because a derivation needs no mpmath.
            from .verify import verify_all

            print(json.dumps(verify_all(arguments.tables, arguments.points, arguments.out)))
        elif arguments.command == "describe":
            table = load(arguments.table)
            print(f'{{"models": {json.dumps(table.models)}, "table": {ir.render(table, [])}}}')
        else:
            table = load(arguments.table)
            if arguments.model not in table.models:
                parser.error(f"{arguments.table.name} lists {', '.join(table.models)}, not {arguments.model}")
            reference.write(table.model(arguments.model), arguments.points, arguments.out)
    except TableError as error:
        print(json.dumps({"diagnostics": [d.as_json() for d in error.diagnostics]}))
        return 2
    except OSError as error:
        print(f"error: {error.filename or 'output'}: {error.strerror or error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        # The driver, which the same signal reaches, says so.
        return 1
    except Exception as error:
        print(f"error: {escaped(error)}", file=sys.stderr)
        return 1
    return 0


def _derive(paths: list[Path], out: Path, known: list[str], audit_known: bool) -> None:
    tables: list[Table] = []
    diagnostics: list[Diagnostic] = []
    for path in paths:
        try:
            tables.append(load(path))
        except TableError as error:
            diagnostics += error.diagnostics
    if diagnostics:
        raise TableError(diagnostics)
    for name, text in derive_all(tables, known, audit_known=audit_known).items():
        (out / f"{name}.json").write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    sys.exit(main())
