"""The audit of the printed equations: what it must find, what it must not, and that nothing in it is typed."""

import cmath
import dataclasses
import functools
import json
import os
import random
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

import mpmath
import pytest
import sympy

from ahv_generator import audit
from ahv_generator.audit import checks, corrected, dimensions, latex, report, terms
from ahv_generator.audit.compare import MISPRINT, TRUNCATION, compare
from ahv_generator.audit.derived import derive, read
from ahv_generator.audit.printed import EQUATIONS, TABLE_2, Printed

Key = tuple[str, str]

PRINTED = {e.key: e for e in EQUATIONS}
DERIVED = derive(EQUATIONS)
COMPARED = report.by_key()
RESULTS = sorted(COMPARED)

# Section 2 of science.md and the reading of the paper: equation, function, kinds of its misprinted terms, and whether
# a dimension betrays them.
MISPRINTS = {
    ("(15)", "eta_d"): (["sign"], False),
    ("(19)", "eta_n"): (["sign"], False),
    ("(24)", "d_chi"): (["factor"], True),
    ("(26)", "d_chi"): (["factor"], True),
    ("(28)", "H_V"): (["factor"], False),
    ("(30)", "g_gamma"): (["factor", "factor"], False),
    ("(32)", "f_alpha"): (["factor", "factor"], False),
    ("(33)", "f_alpha_eta"): (["sign"], False),
    ("(33)", "h_alpha_i"): (["sign"], False),
    ("(34)", "g_Q"): (["repeated superscript"], False),
    ("(34)", "h_Q"): (["prefactor"], True),
    ("(34)", "H_Q"): (["missing term", "missing term"], False),
}

Q_M, Q_MV, Q_I = "dynamic_pressure*s/m", "dynamic_pressure*s/(m*velocity)", "dynamic_pressure*s/i_yy"
LAW = "(-c_l_delta_e/c_l_delta_c)"
CORRECTED = {
    "f_V": f"{Q_M}*(cos(alpha)*(c_t_alpha*alpha + c_t_0) - c_d_alpha*alpha - (c_d_delta_e + c_d_delta_c*{LAW})*delta_e"
    " - c_d_0) - g*sin(gamma) + f_V_eta",
    "g_V": f"{Q_M}*cos(alpha)*(c_t_phi_alpha*alpha + c_t_phi)",
    "h_V": f"{Q_M}*(cos(alpha)*c_t_eta - c_d_eta)",
    "f_V_eta": f"{Q_M}*(cos(alpha)*c_t_eta - c_d_eta)*n/omega**2",
    "H_V": f"{Q_M}*(cos(alpha)*(c_t_alpha + c_t_phi_alpha*phi) - c_d_alpha)",
    "f_gamma": f"{Q_MV}*(c_l_0 + sin(alpha)*(c_t_phi*phi + c_t_0)) - g/velocity*cos(gamma) + f_gamma_eta",
    "g_gamma": f"{Q_MV}*(c_l_alpha + sin(alpha)*(c_t_phi_alpha*phi + c_t_alpha))",
    "h_gamma": f"{Q_MV}*(sin(alpha)*c_t_eta + c_l_eta)",
    "f_gamma_eta": f"{Q_MV}*(sin(alpha)*c_t_eta + c_l_eta)*n/omega**2",
    "H_gamma": f"{Q_MV}*(c_l_alpha + sin(alpha)*(c_t_phi_alpha*phi + c_t_alpha))",
    "f_alpha": f"-{Q_MV}*(c_l_0 + c_l_alpha*alpha + sin(alpha)*(c_t_phi_alpha*phi*alpha + c_t_alpha*alpha"
    " + c_t_phi*phi + c_t_0)) + g/velocity*cos(gamma) + f_alpha_eta",
    "g_alpha": "1",
    "h_alpha": f"-{Q_MV}*(sin(alpha)*c_t_eta + c_l_eta)",
    "f_alpha_eta": f"-{Q_MV}*(sin(alpha)*c_t_eta + c_l_eta)*n/omega**2",
    "H_alpha": f"-{Q_MV}*(c_l_alpha + sin(alpha)*(c_t_phi_alpha*phi + c_t_alpha))",
    "f_Q": f"{Q_I}*(z_t*(c_t_phi_alpha*phi*alpha + c_t_phi*phi + c_t_alpha*alpha + c_t_0)"
    " + c_bar*(c_m_alpha_2*alpha**2 + c_m_alpha*alpha + c_m_0)) + f_Q_eta",
    "g_Q": f"{Q_I}*c_bar*(c_m_delta_e + c_m_delta_c*{LAW})",
    "h_Q": f"{Q_I}*(z_t*c_t_eta + c_bar*c_m_eta)",
    "f_Q_eta": f"{Q_I}*(z_t*c_t_eta + c_bar*c_m_eta)*n/omega**2",
    "H_Q": f"{Q_I}*(c_bar*c_m_alpha + z_t*(c_t_phi_alpha*phi + c_t_alpha))",
}


@functools.cache
def document() -> Any:
    return json.loads(audit.render())


def vanishes(text: str) -> bool:
    return bool(sympy.expand(read(text)) == 0)


# ---------------------------------------------------------------- what is found


def test_exactly_the_known_misprints_are_found() -> None:
    found = {key: [d.kind for d in c.of(MISPRINT)] for key, c in COMPARED.items() if c.of(MISPRINT)}
    assert found == {key: kinds for key, (kinds, _) in MISPRINTS.items()}


def test_the_report_says_which_misprints_a_dimension_betrays() -> None:
    for equation in document()["equations"]:
        betrayed = [d["dimension_betrays"] for d in equation["differences"] if d["class"] == MISPRINT]
        kinds, expected = MISPRINTS.get((equation["number"], equation["name"]), ([], False))
        assert betrayed == [expected] * len(kinds)
        assert (equation["verdict"] == "misprinted") == bool(kinds)
        assert (equation["corrected"] is not None) == bool(kinds)


@pytest.mark.parametrize("name", CORRECTED)
def test_corrected_functions_are_those_that_the_model_is_built_from(name: str) -> None:
    assert vanishes(f"({audit.corrected_expressions()[name]}) - ({CORRECTED[name]})")


def test_corrected_functions_are_these_and_no_others() -> None:
    assert set(audit.corrected_expressions()) == set(CORRECTED)


def test_what_is_not_misprinted_is_left_as_printed() -> None:
    unchanged = {e.right for e in EQUATIONS if e.role == "result" and e.key not in MISPRINTS}
    for name in ("f_V", "g_V", "f_gamma", "H_gamma", "H_alpha", "f_Q", "g_alpha"):
        assert audit.corrected_expressions()[name] in unchanged


@pytest.mark.parametrize("key", RESULTS, ids="-".join)
def test_classed_differences_are_the_whole_difference(key: Key) -> None:
    parts = [terms.total([t]) for t in terms.expand(PRINTED[key].right)]
    for d in COMPARED[key].differences:
        parts += [f"-({terms.total([d.printed])})"] if d.printed else []
        parts += [terms.total([d.derived])] if d.derived else []
    derived = " + ".join(f"({part.text})" for part in DERIVED[key])
    left = read(" + ".join(f"({p})" for p in parts or ["0"]))
    left = left.subs(read("sqrt(zeta**2 - 1)"), sympy.I * read("sqrt(1 - zeta**2)"))
    assert checks.vanishes(sympy.expand(left - read(derived)))


def test_truncations_are_of_the_declared_kinds_and_orders() -> None:
    lowest = {"f": 2, "g": 2, "H": 1}
    for (number, name), compared in COMPARED.items():
        for d in compared.of(TRUNCATION):
            assert d.derived is not None
            powers = d.derived.powers
            order = powers.get("alpha", 0) + powers.get("delta_e", 0) + powers.get("sin(alpha)", 0)
            if d.kind == "high order":
                assert order >= lowest[name[0]]
            elif d.kind in ("constant sin and cos", "constant force"):
                assert name.startswith("H_")
            else:
                assert (number, d.kind) in {
                    ("(25)", "transient"),
                    ("(27)", "leading order"),
                    ("(27)", "noise column"),
                }


def test_a_repeated_superscript_makes_the_printed_function_vanish() -> None:
    (found,) = [e for e in document()["equations"] if e["name"] == "g_Q"]
    assert sympy.expand(read(PRINTED["(34)", "g_Q"].right)) == 0
    assert any("cancel" in note for note in found["notes"])


# ---------------------------------------------------------------- a changed transcription


@pytest.mark.parametrize("key", [k for k in RESULTS if terms.expand(PRINTED[k].right)], ids="-".join)
def test_a_sign_changed_in_the_data_is_reported(key: Key) -> None:
    equation = PRINTED[key]
    for k, term in enumerate(listed := terms.expand(equation.right)):
        if term.shared or "cosh" in equation.right:
            continue
        changed = [t.negative() if j == k else t for j, t in enumerate(listed)]
        after = compare(dataclasses.replace(equation, right=terms.total(changed)), DERIVED[key])
        kinds = [d.kind for d in after.of(MISPRINT)]
        if key in MISPRINTS:
            assert kinds != MISPRINTS[key][0]
        else:
            assert kinds in (["sign"], ["sign and factor"])


def test_a_change_reaches_the_rendered_audit() -> None:
    def changed(e: Printed) -> Printed:
        text = e.right.replace("c_l_0 + sin", "c_l_0 - sin")
        return dataclasses.replace(e, right=text) if e.key == ("(30)", "f_gamma") else e

    rendered = json.loads(report.render(tuple(changed(e) for e in EQUATIONS)))
    (found,) = [e for e in rendered["equations"] if e["name"] == "f_gamma"]
    assert found["verdict"] == "misprinted"
    assert [d["kind"] for d in found["differences"] if d["class"] == MISPRINT] == ["sign", "sign"]


@pytest.mark.parametrize(
    ("key", "old", "new", "kinds"),
    [
        (("(28)", "g_V"), "c_t_phi_alpha*alpha", "c_t_phi_alpha", ["factor"]),
        (("(28)", "f_V"), "cos(alpha)*(c_t_alpha*alpha + c_t_0)", "(cos(alpha)*c_t_alpha*alpha + c_t_0)", ["factor"]),
        (("(31)", "h_gamma_i"), "c_l_eta", "c_d_eta", ["surplus term", "missing term"]),
        (("(34)", "H_Q"), "c_m_alpha", "c_m_delta_e", ["coefficient"]),
        (("(34)", "f_Q"), "c_bar*(", "(", ["prefactor"] * 3),
        (("(30)", "H_gamma"), " + sin(alpha)*c_t_alpha", "", ["high order"]),
        (("(23)", "b"), "zeta*sigma/omega", "sigma/omega", ["prefactor"]),
        (("(28)", "f_V"), " - c_d_0", "", ["missing term"]),
        (("(28)", "f_V"), " - c_d_0", " - c_d_0 - c_m_0", ["surplus term"]),
        (("(28)", "f_V"), "c_d_alpha*alpha", "2*c_d_alpha*alpha", ["factor"]),
    ],
)
def test_other_changes_are_classed(key: Key, old: str, new: str, kinds: list[str]) -> None:
    assert old in PRINTED[key].right
    changed = compare(dataclasses.replace(PRINTED[key], right=PRINTED[key].right.replace(old, new)), DERIVED[key])
    before = Counter(d.kind for d in COMPARED[key].differences)
    assert Counter(d.kind for d in changed.differences) - before == Counter(kinds)


# ---------------------------------------------------------------- the derivation, against numbers

RATES = {"V": "velocity_dot", "gamma": "gamma_dot", "alpha": "alpha_dot", "Q": "pitch_rate_dot"}
FUNCTIONS = {"sin": cmath.sin, "cos": cmath.cos, "exp": cmath.exp, "sqrt": cmath.sqrt}
FUNCTIONS |= {"cosh": cmath.cosh, "sinh": cmath.sinh}


def value(text: str, point: Mapping[str, Any]) -> Any:
    return eval(text, {"__builtins__": {}}, {**FUNCTIONS, **point})


def names_of(*texts: str) -> set[str]:
    return set(re.findall(r"[A-Za-z_]\w*", " ".join(texts))) - set(FUNCTIONS)


def drawn(seed: int) -> dict[str, Any]:
    """Values of all names that the derived functions hold."""
    source = random.Random(seed)
    texts = [part.text for parts in DERIVED.values() for part in parts]
    texts += [e.right for e in EQUATIONS]
    return {name: source.uniform(0.4, 1.6) for name in sorted(names_of(*texts))}


def row(name: str, point: Mapping[str, Any]) -> tuple[Any, Any]:
    """A row of (1), evaluated as (1)-(4) and (25) say, without algebra."""
    p = dict(point)
    p["delta_c"] = value(PRINTED["(4)", "delta_c"].right, p)
    p["c_n_fit"] = value(PRINTED["(3)", "c_n_fit"].right, p)
    p["n"] = value(PRINTED["(2)", "n"].right, p)
    p["eta"] = p["n"] / p["omega"] ** 2 + p["chi"]
    for fit in ("c_t_phi_fit", "c_t_fit", "c_l_fit", "c_d_fit", "c_m_fit"):
        p[fit] = value(PRINTED["(3)", fit].right, p)
    for force in ("thrust", "lift", "drag", "pitching_moment"):
        p[force] = value(PRINTED["(2)", force].right, p)
    return value(PRINTED["(1)", name].right, p), p["n"]


@pytest.mark.parametrize("letter", RATES)
@pytest.mark.parametrize("seed", [1, 2])
def test_derived_functions_agree_with_the_equations_they_come_from(letter: str, seed: int) -> None:
    point = drawn(seed)
    by_name = {name: "+".join(f"({p.text})" for p in parts) for (_, name), parts in DERIVED.items()}
    whole, point["n"] = row(RATES[letter], point)
    point[f"f_{letter}_eta"] = value(by_name[f"f_{letter}_eta"], point)
    point[f"h_{letter}_i"] = value(by_name[f"h_{letter}_i"], point)
    f, g, h, slope = (value(by_name[f"{part}_{letter}"], point) for part in "fghH")
    control = {"V": "phi", "gamma": "alpha", "alpha": "pitch_rate", "Q": "delta_e"}[letter]
    assert f + g * point[control] + h * point["chi"] == pytest.approx(whole, rel=1e-12)

    def derivative(name: str) -> Any:
        shifted, _ = row(RATES[letter], point | {name: complex(point[name], 1e-30)})
        return shifted.imag / 1e-30

    assert slope == pytest.approx(derivative("alpha"), rel=1e-12)
    assert h == pytest.approx(derivative("chi"), rel=1e-12)
    if letter in ("V", "alpha"):  # elsewhere the split is not a derivative
        assert g == pytest.approx(derivative(control), rel=1e-12)
    noise = {"w_gamma": 0.7, "w_q": 0.3}
    column = value(DERIVED["(27)", RATES[letter]][-1].text, point | noise)
    expected = derivative("gamma") * noise["w_gamma"] + derivative("pitch_rate") * noise["w_q"]
    assert column == pytest.approx(expected, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("zeta", [0.3, 0.7, 1.7])
def test_printed_exponential_is_the_matrix_exponential(zeta: float) -> None:
    point = {"zeta": zeta, "omega": 2.3, "t": 0.9}
    expected = mpmath.expm(mpmath.matrix([[0, 1], [-(2.3**2), -2 * zeta * 2.3]]) * 0.9)
    for i in (0, 1):
        for j in (0, 1):
            printed = value(PRINTED["(13)", f"e_{i + 1}{j + 1}"].right, point)
            point[f"e_{i + 1}{j + 1}"] = printed
            found = value(PRINTED["(14)", f"transition_{i + 1}{j + 1}"].right, point)
            assert complex(found) == pytest.approx(complex(expected[i, j]), rel=1e-12)


@pytest.mark.parametrize(("number", "name", "force"), [("(15)", "eta_d", "n_d"), ("(19)", "eta_n", "sigma*c")])
def test_the_corrected_response_satisfies_its_equation_and_the_printed_one_does_not_start_as_given(
    number: str, name: str, force: str
) -> None:
    key = (number, name)
    right = corrected.correct(PRINTED[key], COMPARED[key])
    functions = {"sin": mpmath.sin, "cos": mpmath.cos, "exp": mpmath.exp, "sqrt": mpmath.sqrt}
    functions |= {"cosh": mpmath.cosh, "sinh": mpmath.sinh}
    given = {
        "zeta": mpmath.mpf("0.6"),
        "omega": mpmath.mpf("2.3"),
        "n_d": mpmath.mpf("1.7"),
        "sigma": mpmath.mpf("1.3"),
    }
    given |= {"c": mpmath.mpf("0.8"), f"{name}_0": mpmath.mpf("0.4"), f"{name}_dot_0": mpmath.mpf("-0.9")}

    def solution(text: str) -> Callable[[Any], Any]:
        def at(t: Any) -> Any:
            p = functions | given | {"t": t}
            p |= {f"e_{ij}": eval(PRINTED["(13)", f"e_{ij}"].right, {}, p) for ij in ("11", "12")}
            return mpmath.re(eval(text, {}, p))

        return at

    eta = solution(right)
    for t in (0.2, 1.1):
        left = mpmath.diff(eta, t, 2) + 2 * given["zeta"] * given["omega"] * mpmath.diff(eta, t)
        assert left + given["omega"] ** 2 * eta(t) == pytest.approx(float(eval(force, {}, given)), abs=1e-6)
    assert eta(0) == pytest.approx(0.4)
    assert mpmath.diff(eta, 0) == pytest.approx(-0.9, abs=1e-6)
    off = mpmath.diff(solution(PRINTED[key].right), 0) + mpmath.mpf("0.9")
    assert off == pytest.approx(float(2 * given["zeta"] / given["omega"] * eval(force, {}, given)), abs=1e-6)


def test_all_checks_hold_but_for_the_start_of_the_printed_responses() -> None:
    failing = {c["statement"]: c["left_over"] for c in document()["checks"] if not c["holds"]}
    assert failing == {
        "the printed (15) has the initial rate that it is given": r"\frac{2 \zeta_1 N_1^d}{\omega_1}",
        "the printed (19) has the initial rate that it is given": r"\frac{2 \zeta_1 \sigma_1 c}{\omega_1}",
    }


# ---------------------------------------------------------------- dimensions


def test_pint_finds_the_misprints_that_have_a_wrong_dimension() -> None:
    clashing = {e.key for e in EQUATIONS if dimensions.check(e).clashes}
    assert clashing == {key for key, (_, betrayed) in MISPRINTS.items() if betrayed}


def test_pint_finds_the_rows_of_table_2() -> None:
    found = {(r.printed.name, r.printed.mode): (r.finding, r.swapped_with) for r in dimensions.check_table(TABLE_2)}
    expected = {("velocity", "i"): ("swapped", "altitude"), ("altitude", "i"): ("swapped", "velocity")}
    expected |= {("eta", i): ("normalisation", "") for i in "123"} | {("delta_e", "i"): ("unit missing", "")}
    assert {key: row for key, row in found.items() if row[0]} == expected


@pytest.mark.parametrize("key", RESULTS, ids="-".join)
def test_every_derived_form_is_of_one_dimension(key: Key) -> None:
    for part in DERIVED[key]:
        changed = dataclasses.replace(PRINTED[key], right=part.text)
        assert not dimensions.check(changed).clashes


# ---------------------------------------------------------------- the text


def test_latex_is_well_formed() -> None:
    texts = [t for e in document()["equations"] for t in (e["printed"], e["derived"], e["corrected"]) if t]
    texts += [t for e in document()["equations"] for d in e["differences"] for t in (d["printed"], d["derived"]) if t]
    for text in texts:
        assert text.count("{") == text.count("}")
        assert text.count("bigl") == text.count("bigr") and text.count("Bigl") == text.count("Bigr")
        assert text.count(r"\left") == text.count(r"\right")
        assert not re.search(r"\^(?:\{[^{}]*\}|\w|\\\w+)\^", text), text


def test_long_equations_are_broken_into_lines() -> None:
    for equation in document()["equations"]:
        for text in (equation["printed"], equation["derived"], equation["corrected"]):
            for line in (text or "").splitlines():
                assert latex.visible(line) < 105, line


@pytest.mark.parametrize("seed", ["1", "2"])
def test_the_audit_is_the_same_text_every_time(seed: str) -> None:
    command = [sys.executable, "-c", "from ahv_generator import audit; print(audit.render(), end='')"]
    environment = os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)}
    other = subprocess.run(command, env=environment, capture_output=True, text=True, check=True, encoding="utf-8")
    assert other.stdout == audit.render()
