"""Monte Carlo beyond one machine: shards of members on the workers of Dask."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Iterator, Mapping
from concurrent.futures import CancelledError
from contextlib import contextmanager
from itertools import islice
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from . import _models
from ._command import Option, told, words
from ._errors import AhvError, RequestError
from ._load import loaded
from ._model import Model
from ._results import MonteCarlo

# Seconds to wait for an answer of a scheduler that is named by its address.
_CONNECT_S = 30.0
# Shards a worker thread is given in advance: a scheduler holds few tasks whatever the members.
_AHEAD = 4


def campaign(
    model: Model,
    *,
    members: int,
    t_end: float,
    out: str | PathLike[str],
    client: Any = None,
    workers: int = 2,
    progress: bool | None = None,
    **options: Option,
) -> MonteCarlo:
    """Flies members in shards on the workers of Dask; what is on disk already is not flown again.

    The shards, the files and the outcome are those of ``ahv montecarlo --out DIR --resume``, with the bits of
    `Model.montecarlo` whatever the workers. A worker that dies loses the shard at which it was, which another flies.

    Parameters
    ----------
    model
        What flies. Workers see its table and files of gains at the same paths.
    members
        Flights.
    t_end
        End of the flights in s.
    out
        Folder of the campaign, which all workers see at the same path.
    client
        A ``dask.distributed.Client``, or the address of a scheduler, such as ``"tcp://head:8786"``. Where there is
        none, worker processes of this machine do it.
    workers
        How many of those, with a thread each.
    progress
        Say on stderr how far it is; on a terminal where nothing is said.
    **options
        Those of `Model.montecarlo`, and ``shard_members``, a multiple of 2048.

    Raises
    ------
    RequestError
        A folder with a campaign of other options, or at which another is at work; no Dask; no scheduler at the address.
    AhvError
        The scheduler or all workers are gone; the message says how to go on.
    """
    folder = Path(fspath(out)).absolute()
    given: dict[str, Option] = {"members": members, "t_end": t_end, "out": folder, **options}
    if given.get("threads") is not None:
        raise RequestError("threads: a shard flies on one thread of a worker; choose `workers`")
    for flag in ("resume", "plan", "shard", "json"):
        if flag in given:
            raise RequestError(f"{flag}: a campaign sets it itself")
    line = ["montecarlo", *words(_absolute(model.flags(given)))]
    native: Any = model.module.native
    home = getattr(native, "__file__", None)
    if home is None:
        raise RequestError("model: its equations are evaluated by NumPy, and commands that fly need compiled models")
    distributed = _distributed()
    # Trajectories are flown where the outcome is reported.
    shard_line = [word for word in line if not word.startswith("--trajector")]
    plan = json.loads(told(native.command, [*shard_line, "--plan"]))
    lock = _models.CampaignLock(folder)
    try:
        if plan["missing"]:
            with _client(distributed, client, workers) as own:
                _fly(distributed, own, (native.__spec__.name, home), shard_line, plan, _shown(progress))
    finally:
        lock.release()
    outcome = told(native.command, [*line, "--resume", "--json"])
    return MonteCarlo.of(model, json.loads(outcome))


def fly_shard(module: tuple[str, str], line: list[str], number: int) -> int:
    """Flies a shard on this worker, and gives its number.

    Parameters
    ----------
    module
        Name and file of the compiled models.
    line
        The words of the command.
    number
        The shard.
    """
    name, file = module
    if name == "ahv._models":
        native: Any = importlib.import_module(name)
    else:
        native = loaded(Path(file).parent)
    native.command([*line, "--threads=1", f"--shard={number}"])
    return number


def _absolute(options: Mapping[str, Option]) -> dict[str, Option]:
    """Options whose files workers find from any folder."""
    files = ("feedback", "table")
    paths = {name: value for name, value in options.items() if name in files and isinstance(value, str | PathLike)}
    return {**options, **{name: Path(value).absolute() for name, value in paths.items()}}


def _distributed() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError:
        raise RequestError("campaigns need Dask: pip install 'ahv[campaign]'") from None


def _shown(progress: bool | None) -> bool:
    return sys.stderr.isatty() if progress is None else progress


@contextmanager
def _client(distributed: Any, client: Any, workers: int) -> Iterator[Any]:
    """A client of the workers that are asked for; what is made here ends with it."""
    if client is None:
        if workers < 1:
            raise RequestError(f"workers: {workers}; there must be 1 or more")
        cluster = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0")
        with cluster, distributed.Client(cluster) as own:
            yield own
    elif isinstance(client, str):
        try:
            own = distributed.Client(client, timeout=_CONNECT_S)
        except (OSError, ValueError) as error:
            raise RequestError(f"client: there is no scheduler at {client}: {error}") from None
        with own:
            yield own
    else:
        yield client


def _fly(
    distributed: Any, client: Any, module: tuple[str, str], line: list[str], plan: Mapping[str, Any], shown: bool
) -> None:
    """Flies the shards that are missing, some ahead of each thread of the workers."""
    missing = iter(plan["missing"])
    there = plan["shards"] - len(plan["missing"])

    def submit(number: int) -> Any:
        # Not pure: a shard that is lost from disk is flown again though the scheduler remembers it.
        return client.submit(fly_shard, module, line, number, pure=False)

    try:
        client.wait_for_workers(1, timeout=_CONNECT_S)
        threads = sum(client.nthreads().values())
        flying = distributed.as_completed([submit(number) for number in islice(missing, _AHEAD * threads)])
        for future in flying:
            future.result()
            there += 1
            if shown:
                print(f"\rahv: {there} of {plan['shards']} shards", end="", file=sys.stderr, flush=True)
            flying.update(submit(number) for number in islice(missing, 1))
    except (OSError, TimeoutError, CancelledError, distributed.KilledWorker) as error:
        why = " ".join(str(error).split()) or type(error).__name__
        raise AhvError(
            f"the scheduler or its workers are gone ({why}); at least {there} of {plan['shards']} shards are in "
            f"{plan['folder']}. Start a scheduler and call ahv.campaign again with the same arguments: "
            "it goes on with them"
        ) from None
    finally:
        if shown:
            print(file=sys.stderr)
