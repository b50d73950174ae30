"""Models of a user's own tables."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import ahv
from test_functions import points

ROOT = Path(__file__).parents[3]
CONE = ROOT / "examples/winged-cone/winged_cone.toml"


@pytest.fixture(scope="module")
def cone() -> ahv.Model:
    return ahv.load(CONE, compiled=False, progress=False).winged_cone


def test_a_table_without_a_compiler(cone):
    """The published trim of the winged cone: α 0.0312 rad, β 0.1762, δe −0.0069 rad."""
    trim = cone.trim(velocity=15_060.0, altitude=110_000.0)
    assert trim.state.alpha == pytest.approx(0.0312, abs=5e-5)
    assert trim.state.beta == pytest.approx(0.1762, abs=5e-5)
    assert trim.input.delta_e == pytest.approx(-0.0069, abs=5e-5)
    assert np.abs(cone.drift(trim.state, trim.input)).max() < 1e-9
    assert trim.in_validity_box


def test_built_in_tables_have_the_numbers_that_are_compiled():
    table = ROOT / "generator/tables/dcom.toml"
    for options in ({}, {"set": "section5.3"}, {"canard": "free", "earth": "spherical"}):
        compiled = ahv.model("sdcom", **options)
        loaded = ahv.load(table, compiled=False, progress=False).model("sdcom", **options)
        np.testing.assert_array_equal(loaded.parameters.values, compiled.parameters.values)
        bounds = [
            np.array([*model.state_bounds.values(), *model.input_bounds.values()]) for model in (loaded, compiled)
        ]
        np.testing.assert_allclose(*bounds, rtol=1e-15)
        assert (loaded.states, loaded.inputs, loaded.outputs) == (compiled.states, compiled.inputs, compiled.outputs)
        x, u = points(compiled, 25)
        for kind in ("drift", "diffusion", "output", "parameter_jacobian"):
            own, theirs = (getattr(model, kind)(x, u) for model in (loaded, compiled))
            np.testing.assert_allclose(own, theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())
        for own, theirs in zip(loaded.jacobians(x, u), compiled.jacobians(x, u), strict=True):
            np.testing.assert_allclose(own, theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())
        flight = {"velocity": 7800.0, "gamma": 0.01}
        own, theirs = loaded.trim(**flight), compiled.trim(**flight)
        np.testing.assert_allclose(own.state.values, theirs.state.values, rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(own.input.values, theirs.input.values, rtol=1e-9, atol=1e-11)
        own, theirs = (
            model.linearize(at, outputs=["gamma", "lift"]) for model, at in ((loaded, own), (compiled, theirs))
        )
        np.testing.assert_allclose(own.C, theirs.C, rtol=1e-6, atol=1e-6 * np.abs(theirs.C).max())
        values = [np.array([pole.value for pole in system.poles()]) for system in (own, theirs)]
        np.testing.assert_allclose(*values, rtol=1e-6, atol=1e-6)


def test_the_same_interface(cone):
    system = cone.linearize(outputs=["velocity", "gamma"])
    assert system.to_control().nstates == len(cone.states)
    assert system.zeros().normal_rank == 2
    function = cone.casadi()
    x, u = (rows[0] for rows in points(cone, 1))
    np.testing.assert_allclose(np.array(function(x=x, u=u)["drift"])[:, 0], cone.drift(x, u), rtol=1e-12)
    with pytest.raises(ahv.RequestError, match="montecarlo needs compiled models"):
        cone.montecarlo(members=10, t_end=1.0)
    with pytest.raises(ahv.RequestError, match="x: number 3 of row 0 is not finite"):
        cone.drift([15_000.0, 1e5, 0.0, np.nan, 0.0, 0.1, 0.0], [0.1, 0.0])


def test_faults_have_a_place(tmp_path):
    for file in CONE.parent.glob("winged_cone.*"):
        shutil.copy(file, tmp_path)
    table = tmp_path / CONE.name
    table.write_text(table.read_text().replace("m = { value = 9375.0,", "m = { value = -1.0,"))
    with pytest.raises(ahv.RequestError, match=r"winged_cone\.toml"):
        ahv.load(table, compiled=False, progress=False)
    with pytest.raises(ahv.RequestError, match=r"path: cannot read .*none\.toml"):
        ahv.load(tmp_path / "none.toml")
    with pytest.raises(ahv.RequestError, match="holds no sources of ahv"):
        ahv.load(CONE, source=tmp_path)


def test_rust_is_missing_in_plain_words(monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(ahv.RequestError, match="there is no cargo; install Rust"):
        ahv.load(CONE, source=ROOT)
    monkeypatch.delenv("AHV_SOURCE", raising=False)
    with pytest.raises(ahv.RequestError, match="give the folder, or set AHV_SOURCE"):
        ahv.load(CONE)


def test_a_table_is_compiled():
    """The same vehicle compiled, with all commands, beside the models of the wheel in one process."""
    package = ahv.load(CONE, source=ROOT, profile="dev", progress=False)
    compiled, read = package.winged_cone, ahv.load(CONE, compiled=False, progress=False).winged_cone
    x, u = points(compiled, 50)
    np.testing.assert_allclose(compiled.drift(x, u), read.drift(x, u), rtol=1e-12, atol=1e-12)
    condition = {"velocity": 15_060.0, "altitude": 110_000.0}
    assert compiled.trim(**condition).state.alpha == pytest.approx(read.trim(**condition).state.alpha, rel=1e-10)
    assert any(pole.mode for pole in compiled.poles())
    flown = compiled.montecarlo(members=16, t_end=0.1, dt=0.01, disperse=True)
    assert flown.members == 16
    with pytest.raises(ahv.RequestError, match="unknown model `dcom`; known: winged_cone"):
        package.model("dcom")
    assert ahv.load(CONE, source=ROOT, profile="dev").models() == package.models()
    assert ahv.dcom.trim().in_validity_box


def test_generate(tmp_path):
    told = ahv.generate(CONE.parent, out=tmp_path / "models", package="cone", core_path="core")
    assert (tmp_path / "models/src/winged_cone/drift.rs").is_file()
    assert isinstance(told, dict)
    with pytest.raises(ahv.RequestError):
        ahv.generate(tmp_path / "nowhere", out=tmp_path / "none", package="cone", core_path="core")
