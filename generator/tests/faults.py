"""Prints the faults of tables, for `tests/tests/rules`: one JSON line a table, each fault as rule, part and path."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from ahv_generator.diagnostics import TableError
from ahv_generator.table import load


def faults(path: Path) -> list[list[str]]:
    """The faults of a table; none if models can be made from it."""
    try:
        load(path)
    except TableError as error:
        return [[d.rule, d.part, *d.path] for d in error.diagnostics]
    return []


if __name__ == "__main__":
    for table in sorted(Path(sys.argv[1]).glob("*.toml")):
        print(json.dumps(faults(table)))
