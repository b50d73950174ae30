"""Campaigns on real schedulers and workers over TCP: the bits of one process, whatever happens to them."""

import ast
import hashlib
import json
import signal
import subprocess
import sys
import sysconfig
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import ahv
from ahv import _models

distributed = pytest.importorskip("distributed")
parquet = pytest.importorskip("pyarrow.parquet")

COMMAND = Path(sysconfig.get_path("scripts")) / "ahv"
# Six blocks of members, the last of which is a part of one.
FLIGHTS = {"members": 11_000, "t_end": 0.2, "dt": 0.01, "seed": 3, "limit": {"alpha": (-0.02, 0.05)}}
SHARDS = {"shard_members": 2048}
# What the machine decides.
MEASURED = ("seconds", "member_steps_per_second", "threads")


def outcome(result):
    return {name: value for name, value in result.data.items() if name not in MEASURED}


@pytest.fixture(scope="module")
def whole():
    """The engine of one process."""
    return outcome(ahv.sdcom.montecarlo(**FLIGHTS))


@contextmanager
def process(*words):
    running = subprocess.Popen(
        [sys.executable, "-m", *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        yield running
    finally:
        running.kill()
        running.wait()


@contextmanager
def scheduler(folder):
    """A scheduler on a free port of loopback, and its address."""
    file = folder / f"scheduler-{time.monotonic_ns()}.json"
    words = ["distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"]
    with process(*words, "--scheduler-file", str(file)) as running:
        end = time.monotonic() + 60
        while not file.exists():
            assert time.monotonic() < end
            time.sleep(0.05)
        time.sleep(0.2)
        yield running, json.loads(file.read_text())["address"]


def worker(address):
    words = ["distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    return process(*words, "--local-directory", "/tmp")


def shards(folder):
    return sorted((folder / "shards").glob("*.parquet"))


def when(condition, action):
    """Does something as soon as a condition holds, while others go on."""

    def watch():
        while not condition():
            time.sleep(0.01)
        action()

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    return thread


def test_two_local_workers_give_the_bits_of_one_process(tmp_path, whole):
    flown = ahv.campaign(ahv.sdcom, out=tmp_path, **FLIGHTS, **SHARDS)
    assert outcome(flown) == whole
    assert len(shards(tmp_path)) == 6
    # Whatever the split.
    other = ahv.sdcom.montecarlo(out=tmp_path / "other", resume=True, shard_members=6144, **FLIGHTS)
    assert outcome(other) == whole
    assert len(shards(tmp_path / "other")) == 2


def test_a_worker_that_is_killed_changes_nothing(tmp_path, whole):
    with scheduler(tmp_path) as (_, address), worker(address) as first, worker(address):
        out = tmp_path / "campaign"
        killed = when(lambda: len(shards(out)) >= 2, lambda: first.send_signal(signal.SIGKILL))
        with distributed.Client(address) as client:
            client.wait_for_workers(2, timeout=60)
            flown = ahv.campaign(ahv.sdcom, out=out, client=client, **FLIGHTS, **SHARDS)
        killed.join(10)
        assert first.wait(10) == -signal.SIGKILL
    assert outcome(flown) == whole


def test_a_scheduler_that_is_gone_says_how_to_go_on(tmp_path, whole):
    out = tmp_path / "campaign"
    with scheduler(tmp_path) as (running, address), worker(address):
        when(lambda: len(shards(out)) >= 1, running.kill)
        with (
            distributed.Client(address) as client,
            pytest.raises(ahv.AhvError, match=r"gone .* at least \d of 6 shards .*call ahv\.campaign again"),
        ):
            ahv.campaign(ahv.sdcom, out=out, client=client, **FLIGHTS, **SHARDS)
    assert 1 <= len(shards(out)) <= 6
    before = {file: file.stat().st_mtime_ns for file in shards(out)}
    flown = ahv.sdcom.montecarlo(out=out, resume=True, **FLIGHTS, **SHARDS)
    assert outcome(flown) == whole
    # What was there is not flown again.
    assert all(file.stat().st_mtime_ns == was for file, was in before.items())


def test_a_shard_that_is_not_whole_is_flown_again(tmp_path, whole):
    asked = {"out": tmp_path, "resume": True, **FLIGHTS, **SHARDS}
    assert outcome(ahv.sdcom.montecarlo(**asked)) == whole
    first, second, third, *_ = shards(tmp_path)
    first.write_bytes(first.read_bytes()[:1000])
    changed = bytearray(second.read_bytes())
    changed[len(changed) // 4] ^= 1
    second.write_bytes(changed)
    third.unlink()
    (tmp_path / "shards" / ".ahv-half.tmp").write_bytes(b"PAR1")
    with pytest.warns(ahv.AhvWarning, match="is flown again") as said:
        assert outcome(ahv.sdcom.montecarlo(**asked)) == whole
    assert [file.name in str(it.message) for file, it in zip((first, second), said, strict=True)] == [True, True]


@pytest.mark.parametrize(
    ("model", "options", "named"),
    [
        (ahv.sdcom, {"seed": 4}, "--seed was 3 and is 4"),
        (ahv.sdcom, {"dt": 0.02}, "--dt was 0.01 s and is 0.02 s"),
        (ahv.sdcom, {"shard_members": 4096}, "--shard-members was 2048 and is 4096"),
        (ahv.sdcom, {"limit": None}, "--limit was .* and is none"),
        (ahv.sdcom.replace(set="section5.3"), {}, "values of the table"),
    ],
)
def test_another_option_does_not_resume(tmp_path, model, options, named):
    few = {**FLIGHTS, **SHARDS, "members": 2048, "out": tmp_path, "resume": True}
    ahv.sdcom.montecarlo(**few)
    with pytest.raises(ahv.RequestError, match=named):
        model.montecarlo(**{**few, **options})


def test_two_campaigns_into_one_folder(tmp_path):
    lock = _models.CampaignLock(tmp_path)
    with pytest.raises(ahv.RequestError, match="another campaign is at work in"):
        ahv.campaign(ahv.sdcom, out=tmp_path, **FLIGHTS)
    lock.release()
    _models.CampaignLock(tmp_path).release()


def test_a_shard_says_what_it_is(tmp_path):
    flown = ahv.sdcom.montecarlo(out=tmp_path, resume=True, **FLIGHTS, **SHARDS)
    names = ahv.sdcom.states
    tables = [parquet.read_table(file) for file in shards(tmp_path)]
    rows = np.concatenate([np.column_stack([it[f"last_{name}"] for name in names]) for it in tables])
    assert hashlib.sha256(rows.astype("<f8").tobytes()).hexdigest() == flown.digest
    assert [member for it in tables for member in it["member"].to_pylist()] == list(range(FLIGHTS["members"]))
    # By NumPy, of the rows.
    np.testing.assert_allclose(rows.mean(axis=0), flown.mean[-1], rtol=1e-12)
    np.testing.assert_allclose(rows.std(axis=0, ddof=1), flown.std[-1], rtol=1e-9)
    metadata = tables[0].schema.metadata
    units = json.loads(metadata[b"ahv.units"])
    assert [units[f"last_{name}"] for name in names] == list(names.units)
    options = json.loads(metadata[b"ahv.campaign"])
    assert options["--seed"] == "3"
    assert len(options["values of the table (SHA-256)"]) == 64
    # Who has left the limits of alpha by the end.
    left = sum(it["left_limits_alpha"].is_valid().to_numpy().sum() for it in tables)
    assert left / FLIGHTS["members"] == pytest.approx(flown["snapshots"][-1]["left_limits_by_state"]["alpha"]["value"])


def test_one_shard_by_the_command(tmp_path, whole):
    line = ["montecarlo", "--model=sdcom", "--members=11000", "--t-end=0.2", "--dt=0.01", "--seed=3"]
    line += ["--limit=alpha=-0.02rad..0.05rad", "--shard-members=2048", f"--out={tmp_path}"]

    def run(*words):
        return subprocess.run([COMMAND, *line, *words], capture_output=True, text=True, check=False)

    refused = run("--shard=0")
    assert (refused.returncode, "holds no campaign" in refused.stderr) == (2, True)
    plan = json.loads(run("--plan").stdout)
    assert plan["missing"] == list(range(6))
    assert run("--shard=5").returncode == 0
    assert run("--shard=2").returncode == 0
    assert json.loads(run("--plan").stdout)["missing"] == [0, 1, 3, 4]
    refused = run("--shard=6")
    assert (refused.returncode, "they are 0 to 5" in refused.stderr) == (2, True)
    told = json.loads(run("--resume", "--json").stdout)
    assert {name: value for name, value in told.items() if name not in MEASURED} == whole


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"threads": 2}, "threads: a shard flies on one thread"),
        ({"resume": True}, "resume: a campaign sets it"),
        ({"shard_members": 1000}, "multiple of 2048"),
        ({"workers": 0}, "workers: 0"),
        ({"client": "tcp://127.0.0.1:9"}, "client: there is no scheduler at tcp://127.0.0.1:9"),
        ({"members": 1}, "members"),
    ],
)
def test_what_cannot_be_asked(tmp_path, options, named, monkeypatch):
    monkeypatch.setattr("ahv._campaign._CONNECT_S", 2.0)
    with pytest.raises(ahv.RequestError, match=named):
        ahv.campaign(ahv.sdcom, out=tmp_path, **{**FLIGHTS, **options})


def test_no_file_imports_in_a_circle():
    place = Path(ahv.__file__).parent
    imports = {}
    for file in place.glob("_[a-z]*.py"):
        nodes = [it for it in ast.walk(ast.parse(file.read_text())) if isinstance(it, ast.ImportFrom) and it.level]
        imports[file.stem] = {it.module for it in nodes if it.module}
    while free := [name for name, of in imports.items() if not of & imports.keys()]:
        for name in free:
            del imports[name]
    assert not imports
