"""Command line: `python -m ahv_generator derive --out DIR TABLE...`.

Exit codes: 0 done, 2 a table is at fault (its diagnostics stand on standard output as JSON).
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from . import ir
from .diagnostics import Diagnostic, TableError
from .models import BUILDERS
from .table import load


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(prog="ahv_generator")
    commands = parser.add_subparsers(dest="command", required=True)
    derive = commands.add_parser("derive", help="derive the models of tables and write their IR")
    derive.add_argument("--out", type=Path, required=True, help="folder for <table>.json")
    derive.add_argument("tables", type=Path, nargs="+")
    arguments = parser.parse_args()

    texts: dict[str, str] = {}
    diagnostics: list[Diagnostic] = []
    for path in arguments.tables:
        try:
            table = load(path)
        except TableError as error:
            diagnostics += error.diagnostics
            continue
        texts[table.name] = ir.render(table, [BUILDERS[name](table) for name in table.models])
    if diagnostics:
        print(json.dumps({"diagnostics": [d.as_json() for d in diagnostics]}))
        return 2
    for name, text in texts.items():
        (arguments.out / f"{name}.json").write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
