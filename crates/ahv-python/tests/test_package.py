"""The package as a user meets it: names, stubs, import, the command beside it."""

import ast
import inspect
import json
import statistics
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pytest

import ahv
from ahv import _models

COMMAND = Path(sysconfig.get_path("scripts")) / "ahv"
# The bar of the import, in s.
IMPORT = 0.15


def test_models_are_attributes():
    assert list(ahv.models()) == [name for name, _ in _models.models()]
    assert ahv.sdcom.name == "sdcom"
    assert ahv.model("sdcom", canard="free").choices["canard"] == "free"
    assert ahv.sdcom.replace(set="section5.3").set == "section5.3"
    with pytest.raises(AttributeError, match="no attribute 'sdcon'"):
        _ = ahv.sdcon


def test_every_public_name_is_there():
    for name in ahv.__all__:
        found = getattr(ahv, name)
        assert inspect.getdoc(found), name
    for name, member in inspect.getmembers(ahv.Model):
        if not name.startswith("_"):
            assert inspect.getdoc(member), name


def test_stubs_are_current():
    stubs = ast.parse((Path(ahv.__file__).parent / "_models.pyi").read_text())
    described = {node.name for node in stubs.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    # What Rust tells of its functions is their signature.
    compiled = {name for name in dir(_models) if not name.startswith("_")}
    assert described == compiled
    for node in stubs.body:
        if isinstance(node, ast.FunctionDef):
            assert [it.arg for it in node.args.args] == list(inspect.signature(getattr(_models, node.name)).parameters)
        if isinstance(node, ast.ClassDef):
            own = {it.name: it for it in node.body if isinstance(it, ast.FunctionDef) and it.name != "__new__"}
            assert set(own) == {name for name in dir(getattr(_models, node.name)) if not name.startswith("_")}
            for name, method in own.items():
                if not method.decorator_list:
                    signature = inspect.signature(getattr(getattr(_models, node.name), name))
                    assert [it.arg for it in method.args.args] == list(signature.parameters), name


def test_types_are_marked():
    assert (Path(ahv.__file__).parent / "py.typed").is_file()


def test_import_is_quick():
    script = "import time; start = time.perf_counter(); import ahv; ahv.AhvError; print(time.perf_counter() - start)"
    times = [float(subprocess.check_output([sys.executable, "-c", script])) for _ in range(7)]
    assert min(times) <= IMPORT, times
    assert statistics.median(times) < 10 * IMPORT


def test_the_command_is_installed():
    asked = ["trim", "--model", "dcom", "--velocity", "7850", "--json"]
    told = json.loads(subprocess.check_output([COMMAND, *asked]))
    assert told == ahv.dcom.trim(velocity=7850.0).data
    refused = subprocess.run([COMMAND, "trim", "--model", "nothing"], capture_output=True, text=True, check=False)
    assert refused.returncode == 2
    assert "invalid value 'nothing'" in refused.stderr


def test_commands_by_their_flags():
    package = ahv.Package(_models)
    told = package.command("reduce", runs=100, omega=[20.0], zeta=[0.5], sigma=[100.0])
    assert told["experiment"]["runs"] == 100
    # ζω and ζσ/ω, as (23) prints them: a standard deviation of ζσ/ω / √(2 ζω).
    assert told["chi_std"] == pytest.approx([2.5 / 20**0.5])


def test_ctrl_c_ends_flights(tmp_path):
    script = (
        "import ahv\n"
        "try:\n"
        "    print('flying', flush=True)\n"
        "    ahv.sdcom.montecarlo(members=100_000_000, t_end=10.0, dt=0.001)\n"
        "except KeyboardInterrupt:\n"
        "    print('stopped', flush=True)\n"
    )
    flying = subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert flying.stdout is not None
    assert flying.stdout.readline() == "flying\n"
    time.sleep(1.0)
    flying.send_signal(2)
    out, _ = flying.communicate(timeout=60)
    assert out == "stopped\n"
    assert flying.returncode == 0
