"""Bad input: each an exception that names the argument and what was expected, with the texts of the command line."""

import warnings

import numpy as np
import pytest

import ahv

X = ahv.sdcom.trim().state
U = ahv.sdcom.trim().input
NAN = X.replace(alpha=np.nan)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ahv.sdcom.drift(np.zeros(7), U), r"x: its shape is \(7,\); the last dimension must be 8 \(velocity"),
        (lambda: ahv.sdcom.drift(X, 1.0), r"u: its shape is \(\)"),
        (lambda: ahv.sdcom.drift(["a"] * 8, U), "x: its numbers are <U1; they must be real"),
        (lambda: ahv.sdcom.drift(np.zeros(8, complex), U), "x: its numbers are complex128"),
        (lambda: ahv.sdcom.drift(np.zeros((3, 8)), np.zeros((2, 3))), r"leading dimensions do not fit: x: \(3, 8\)"),
        (lambda: ahv.sdcom.drift({"alfa": 1.0}, U), "x: unknown name `alfa`; did you mean `alpha`"),
        (lambda: ahv.sdcom.drift(U, U), "x: it has phi, delta_e"),
        (lambda: ahv.model("sdcom", units="si").drift(X, U), "x: it has velocity \\[ft/s\\]"),
        (lambda: ahv.sdcom.drift(NAN, U), "x: number 3 of row 0 is not finite"),
        (
            lambda: ahv.sdcom.drift(X, U, ahv.sdcom.parameters.replace(m=np.inf)),
            "p: it holds a number that is not finite",
        ),
        (lambda: ahv.sdcom.drift(X, U, out=np.zeros(8, np.float32)), "out: it must be a contiguous array of float64"),
        (lambda: ahv.model("sdcon"), "unknown model `sdcon`; did you mean `sdcom`"),
        (lambda: ahv.model("dcom", set="section9"), "set: unknown set of parameters `section9`"),
        (lambda: ahv.model("dcom", canard="big"), "invalid value 'big' for '--canard"),
        (lambda: ahv.model("com", canard="free"), "canard: com has no such choice"),
        (lambda: ahv.model("dcom", wing="big"), "unexpected argument '--wing"),
        (lambda: ahv.model("dcom", units="cgs"), "invalid value 'cgs' for '--units"),
        (lambda: ahv.model("dcom", table="none.toml"), "cannot read none.toml"),
        (lambda: ahv.dcom.trim(velocity="fast"), "invalid value 'fast'"),
        (lambda: ahv.dcom.trim(velocity=np.nan), "not a finite number"),
        (lambda: ahv.dcom.trim(gamma=2.0), "gamma: .* it must be"),
        (lambda: ahv.dcom.trim(gama=0.1), "unexpected argument '--gama"),
        (lambda: ahv.dcom.trim(input={"delta_x": 0.1}), "input: unknown name `delta_x`"),
        (lambda: ahv.dcom.trim(input={"delta_e": 0.1}), "input: delta_e is not held"),
        (lambda: ahv.dcom.simulate(1.0, -0.1), "--dt"),
        (lambda: ahv.dcom.simulate(1.0, 0.1, scheme="rk5"), "invalid value 'rk5'"),
        (lambda: ahv.com.montecarlo(members=10, t_end=1.0), "com has no noise"),
        (lambda: ahv.sdcom.montecarlo(members=1, t_end=1.0), "1 is not in 2..=1000000000"),
        (lambda: ahv.sdcom.montecarlo(members=10, t_end=1.0, out="/proc/none"), "cannot make the folder /proc/none"),
        (lambda: ahv.sdcom.linearize(X), "a state needs an input"),
    ],
)
def test_a_request_is_refused(call, message):
    with pytest.raises(ahv.RequestError, match=message):
        call()


def test_without_a_trim():
    with pytest.raises(ahv.NumericError, match=r"com_rigid: no trim with delta_e"):
        ahv.com_rigid.trim(altitude=140_000.0)


def test_kinds_of_errors():
    assert issubclass(ahv.RequestError, ValueError)
    assert issubclass(ahv.NumericError, ArithmeticError)
    assert issubclass(ahv.RequestError, ahv.AhvError)


def test_notes_are_warnings():
    with pytest.warns(ahv.AhvWarning, match="outside its validity box") as told:
        ahv.dcom.lqr(velocity=6_990.0)
    assert told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ahv.dcom.lqr()
