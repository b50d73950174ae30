"""Derives the models of tables, by as many processes as there are processors."""

from __future__ import annotations

import gc
import multiprocessing
import multiprocessing.connection
import os
import sys
import threading
import traceback
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from . import emit, ir
from .diagnostics import Diagnostic, Faults, TableError
from .table import Table, load

AUDIT = "audit"
# A family that runs at that time has another `os._exit`.
_EXIT = os._exit
_NOTHING = ir.Part("", frozenset(), frozenset())


@dataclass(frozen=True)
class _Job:
    """A model to derive; with the audit, whose equations its derivation reads anyway, or without."""

    path: Path
    model: str
    audit: bool


@dataclass(frozen=True)
class _Done:
    """A derived model and the audit, or why it cannot be derived."""

    part: ir.Part = _NOTHING
    audit: str | None = None
    faults: tuple[Diagnostic, ...] = ()


# The tables of the jobs by their paths: a process that is forked has them, another reads them again, for the functions
# of a family cannot be sent.
_tables: dict[Path, Table] = {}


def derive(tables: Iterable[Table], known: Iterable[str] = (), *, audit_known: bool = False) -> dict[str, str]:
    """The IR of each table but the `known` ones, by its name; and the audit, empty where it is known.

    Raises:
        TableError: for a table whose models cannot be derived.
    """
    # A derivation is over before its garbage needs room; looking for it takes a tenth of the time.
    gc.disable()
    tables = list(tables)
    audited = [(table.name, model) for table in tables for model in table.audited]
    sought = [table for table in tables if table.name not in known]
    models = [(table, model) for table in sought for model in table.models]
    with_audit = [(t.name, m) for t, m in models if (t.name, m) in audited and not audit_known][:1]
    _tables.update((table.path, table) for table in tables)
    jobs = [_Job(table.path, model, (table.name, model) in with_audit) for table, model in models]
    done = dict(zip(((table.name, model) for table, model in models), _all(jobs), strict=True))
    # Models of one table have most faults in common.
    faults = [next((it for m in table.models if (it := done[table.name, m].faults)), ()) for table in sought]
    diagnostics = [fault for of_table in faults for fault in of_table]
    for table in sought if not diagnostics else ():
        found = Faults(table.path.name)
        emit.check(table.emitted, frozenset().union(*(done[table.name, m].part.groups for m in table.models)), found)
        diagnostics += found.found
    if diagnostics:
        raise TableError(diagnostics)
    texts = {table.name: ir.assemble(table, (done[table.name, m].part for m in table.models)) for table in sought}
    if audited:
        made = next((it.audit for it in done.values() if it.audit is not None), None)
        texts[AUDIT] = "" if audit_known else made or _audit()
    return texts


def _all(jobs: list[_Job]) -> list[_Done]:
    """What the jobs give, in their order; the longest one, that with the audit, starts first."""
    processors = len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1
    workers = min(processors, len(jobs))
    if workers < 2:
        return [_work(job) for job in jobs]
    # What is imported already need not be imported again. Elsewhere the platform decides how a process starts.
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else None)
    order = sorted(range(len(jobs)), key=lambda position: not jobs[position].audit)
    try:
        pool = ProcessPoolExecutor(workers, context, initializer=_end_with_parent)
    except (ImportError, NotImplementedError, OSError):
        # A system without the semaphores that a pool needs.
        return [_work(job) for job in jobs]
    with pool:
        done = dict(zip(order, pool.map(_work, [jobs[position] for position in order]), strict=True))
    return [done[position] for position in range(len(jobs))]


def _end_with_parent() -> None:
    """Ends this process with the one that started it, which a signal may kill."""
    parent = multiprocessing.parent_process()

    def watch() -> None:
        if parent is not None:
            multiprocessing.connection.wait([parent.sentinel])
            _EXIT(1)

    threading.Thread(target=watch, daemon=True).start()


def _work(job: _Job) -> _Done:
    if job.path not in _tables:
        _tables[job.path] = load(job.path)
    try:
        part = ir.part(_tables[job.path].model(job.model))
    except TableError as error:
        return _Done(faults=tuple(error.diagnostics))
    except (MemoryError, OSError):
        raise
    except Exception as error:
        # What the checks of a table let through is a fault of that table all the same.
        message = f"the models cannot be derived from this table: {escaped(error)}"
        fault = Diagnostic("derivation", job.path.name, ("table", "models"), "value", message)
        return _Done(faults=(fault,))
    return _Done(part, _audit() if job.audit else None)


def _audit() -> str:
    # Here, because SymPy takes long to import and most processes need none of it.
    from . import audit

    return audit.render()


def escaped(error: Exception) -> str:
    """An exception that nobody expected, in one line with its place."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({Path(place.filename).name}, line {place.lineno})"
