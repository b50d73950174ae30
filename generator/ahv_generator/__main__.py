"""Command line: `python -m ahv_generator derive --out DIR TABLE...` and `... evaluate`.

`evaluate` writes CasADi's own values of a model at points that the oracle drew.

Exit codes: 0 done, 1 it cannot be done (standard error says why), 2 a table is at fault (its diagnostics stand on
standard output as JSON).
"""

from __future__ import annotations

import argparse
import json
import sys
import traceback
from pathlib import Path

from . import audit, ir, reference
from .diagnostics import Diagnostic, TableError
from .table import load


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="ahv_generator")
    commands = parser.add_subparsers(dest="command", required=True)
    derive = commands.add_parser("derive", help="derive the models of tables and write their IR")
    derive.add_argument("--out", type=Path, required=True, help="folder for <table>.json, audit.json")
    derive.add_argument("tables", type=Path, nargs="+")
    evaluate = commands.add_parser("evaluate", help="evaluate a model at the points of an oracle file")
    evaluate.add_argument("--table", type=Path, required=True)
    evaluate.add_argument("--model", required=True, help="one of the models that the table lists")
    evaluate.add_argument("--points", type=Path, required=True, help="file of reference vectors")
    evaluate.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    try:
        if arguments.command == "derive":
            _derive(arguments.tables, arguments.out)
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
        print(f"error: {_escaped(error)}", file=sys.stderr)
        return 1
    return 0


def _escaped(error: Exception) -> str:
    """An exception that nobody expected, in one line with its place."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({Path(place.filename).name}, line {place.lineno})"


def _derive(tables: list[Path], out: Path) -> None:
    texts: dict[str, str] = {}
    audited = False
    diagnostics: list[Diagnostic] = []
    for path in tables:
        try:
            table = load(path)
        except TableError as error:
            diagnostics += error.diagnostics
            continue
        try:
            models = table.build()
            texts[table.name] = ir.render(table, models)
            audited = audited or any(model.traits.audited for model in models)
        except TableError as error:
            diagnostics += error.diagnostics
        except (MemoryError, OSError):
            raise
        except Exception as error:
            # What the checks of a table let through is a fault of that table all the same.
            message = f"the models cannot be derived from this table: {_escaped(error)}"
            diagnostics.append(Diagnostic("derivation", path.name, ("table", "models"), "value", message))
    if diagnostics:
        raise TableError(diagnostics)
    if audited:
        texts["audit"] = audit.render()
    for name, text in texts.items():
        (out / f"{name}.json").write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    sys.exit(main())
