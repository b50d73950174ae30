"""Models of a user's own tables: derived, written, compiled and loaded."""

from __future__ import annotations

import hashlib
import importlib.machinery
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import _models
from ._command import Option, words
from ._errors import AhvError, RequestError
from ._package import Package

# The variable that names a folder with the sources of ahv.
SOURCE = "AHV_SOURCE"

# The folder with the sources of ahv, and the profile of cargo.
_Build = tuple[Path, str]
_MANIFEST = """\
[workspace]

[package]
name = "ahv-loaded"
version = "0.1.0"
edition = "2024"
publish = false

[lib]
name = "_models"
crate-type = ["cdylib"]

[dependencies]
ahv-python = {{ path = {python}, default-features = false }}
loaded-models = {{ path = "models" }}
pyo3 = {{ version = "0.30", features = ["abi3-py311"] }}

[profile.release]
codegen-units = 8

# As ahv itself is built, so that what both need is built once.
[profile.dev]
opt-level = 1
debug = "line-tables-only"

[profile.dev.package."*"]
debug = false

[profile.dev.package.ahv-loaded]
opt-level = 0
debug = false
"""
_LIBRARY = """\
//! The models of a table, as a module of Python.

ahv_python::module! {{
    /// The compiled models.
    _models, loaded_models::Models, Vec::new(), &[{documents}]
}}
"""


def generate(tables: str | os.PathLike[str] | None = None, **options: Option) -> dict[str, Any]:
    """Derives the models of tables and writes them: the command ``ahv generate``, by the names of its flags.

    Parameters
    ----------
    tables
        Folder of the tables.
    **options
        ``out``, ``package``, ``core_path``, ``target``, ``units``, ``check``, …

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Raises
    ------
    RequestError
        A table or a family has a fault; the message has file and line.
    """
    line = ["generate", *words({"tables": tables, **options, "json": True})]
    done = subprocess.run([sys.executable, "-P", "-m", "ahv", *line], capture_output=True, text=True, check=False)
    # With `check` 1 says that tree and tables differ, and so does the outcome.
    if done.returncode not in (0, 1) or not done.stdout:
        raise RequestError(_plain(done.stderr))
    outcome: dict[str, Any] = json.loads(done.stdout)
    return outcome


def load(
    path: str | os.PathLike[str],
    *,
    compiled: bool = True,
    source: str | os.PathLike[str] | None = None,
    profile: str = "release",
    progress: bool = True,
) -> Package:
    """The models of a table of one's own.

    They are derived, written, compiled and loaded once; after that they come from the cache, as long as the table, the
    Python files beside it and ahv stay the same.

    Parameters
    ----------
    path
        A table; its family is built in or lies beside it.
    compiled
        Compile the models, which takes Rust and some minutes; otherwise their equations are evaluated by NumPy, with
        functions of arrays, trims, linear systems, poles, zeros and regulators of matrices, and without flights.
    source
        Folder with the sources of ahv that the compiled models are built with; the one that the variable ``AHV_SOURCE``
        names where none is given.
    profile
        ``"release"``, or ``"dev"``: sooner compiled, and slow.
    progress
        Say on stderr what is being done.

    Raises
    ------
    RequestError
        A fault of the table or its family, with file and line; Rust or the sources of ahv are missing.
    """
    table = Path(path)
    try:
        text = table.read_bytes()
    except OSError as error:
        raise RequestError(f"path: cannot read {table}: {error.strerror}") from None
    home = _source(source) if compiled else None
    beside = sorted(table.parent.glob("*.py"))
    folder = _cache() / _key(table, text, beside, (home, profile) if home else None)
    say = (lambda what: print(f"ahv: {what}", file=sys.stderr)) if progress else (lambda _: None)
    if not (folder / "complete").is_file():
        _make(folder, table, beside, (home, profile) if home else None, say)
    if not compiled:
        from ._interpreted import Interpreted

        return Package(Interpreted(text.decode(), [file.read_text(encoding="utf-8") for file in _documents(folder)]))
    return Package(loaded(folder))


def _make(folder: Path, table: Path, beside: list[Path], build: _Build | None, say: Any) -> None:
    """Makes a folder of the cache aside, and moves it to its place when it is whole."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent, prefix=".making-") as made:
        new = Path(made) / "new"
        (new / "tables").mkdir(parents=True)
        for file in (table, *beside):
            shutil.copy(file, new / "tables" / file.name)
        say(f"deriving the models of {table.name}")
        core = build[0] / "crates/ahv-core" if build else Path("ahv-core")
        try:
            generate(new / "tables", out=new / "models", package="loaded-models", core_path=str(core))
        except RequestError as error:
            # Faults are of the user's own files.
            raise RequestError(str(error).replace(str(new / "tables"), str(table.parent))) from None
        if build:
            _compile(new, build, say)
        (new / "complete").touch()
        # Another process may have been faster.
        if not folder.exists():
            new.replace(folder)


def _documents(folder: Path) -> list[Path]:
    """The IR of a folder of the cache."""
    return [file for file in sorted((folder / "models/ir").glob("*.json")) if file.name != "audit.json"]


def _compile(new: Path, build: _Build, say: Any) -> None:
    home, profile = build
    included = ", ".join(f'include_str!("../models/ir/{file.name}")' for file in _documents(new))
    (new / "Cargo.toml").write_text(
        _MANIFEST.format(python=json.dumps(str(home / "crates/ahv-python"))), encoding="utf-8"
    )
    (new / "src").mkdir()
    (new / "src/lib.rs").write_text(_LIBRARY.format(documents=included), encoding="utf-8")
    shutil.copy(home / "crates/ahv-python/Cargo.lock", new / "Cargo.lock")
    say("compiling them (once; some minutes)")
    environment = {**os.environ, "PYO3_PYTHON": sys.executable}
    environment.setdefault("CARGO_TARGET_DIR", str(_cache() / "target"))
    target = Path(environment["CARGO_TARGET_DIR"])
    line = ["cargo", "build", "--profile", profile, "--quiet", "--manifest-path", str(new / "Cargo.toml")]
    done = subprocess.run(line, env=environment, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        raise AhvError(f"the models do not compile: {done.stderr.strip()}")
    built = {"darwin": "lib_models.dylib", "win32": "_models.dll"}.get(sys.platform, "lib_models.so")
    shutil.copy(target / ("debug" if profile == "dev" else profile) / built, new / _file())


def loaded(folder: Path) -> Any:
    """The compiled module of a folder of the cache."""
    name = f"ahv._loaded_{folder.name}._models"
    if name in sys.modules:
        return sys.modules[name]
    loader = importlib.machinery.ExtensionFileLoader(name, str(folder / _file()))
    spec = importlib.util.spec_from_loader(name, loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    sys.modules[name] = module
    return module


def _file() -> str:
    return f"_models{importlib.machinery.EXTENSION_SUFFIXES[-1]}"


def _source(source: str | os.PathLike[str] | None) -> Path:
    """The folder with the sources of ahv, and a Rust that compiles them."""
    named = source or os.environ.get(SOURCE)
    if not named:
        raise RequestError(
            f"source: compiled models are built with the sources of ahv; give the folder, or set {SOURCE}; "
            "compiled=False needs none"
        )
    home = Path(named).resolve()
    if not (home / "crates/ahv-python/Cargo.toml").is_file():
        raise RequestError(f"source: {home} holds no sources of ahv: it has no crates/ahv-python")
    if shutil.which("cargo") is None:
        raise RequestError("compiled: there is no cargo; install Rust (rustup.rs), or load with compiled=False")
    return home


def _key(table: Path, text: bytes, beside: list[Path], build: _Build | None) -> str:
    """A name for what the models are made of."""
    digest = hashlib.sha256(repr((table.name, build)).encode())
    digest.update(text)
    # What the module was built of decides about the models, too.
    for file in (*beside, Path(str(_models.__file__))):
        digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()[:24]


def _cache() -> Path:
    """The folder of the cache, where ``ahv generate`` has its own."""
    variables: Mapping[str, str] = {name: value for name, value in os.environ.items() if value}
    if own := variables.get("AHV_CACHE_DIR"):
        return Path(own) / "loaded"
    if sys.platform == "win32":
        parent = Path(variables["LOCALAPPDATA"])
    elif sys.platform == "darwin":
        parent = Path.home() / "Library/Caches"
    else:
        parent = Path(variables.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return parent / "ahv" / "loaded"


def _plain(said: str) -> str:
    """What a command says on stderr, without the mark of an error."""
    return said.strip().removeprefix("error: ").removeprefix("× ")
