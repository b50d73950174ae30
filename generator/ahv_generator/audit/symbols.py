"""The names that the printed equations are written in: their LaTeX symbols and their units."""

from __future__ import annotations

import re

FLEXIBLE = "(ft*slug)^0.5"
_INVERSE = "1/(ft*slug)^0.5"

# `{i}` is the index of the flexible mode, as printed.
_PLAIN: dict[str, tuple[str, str]] = {
    "velocity": ("V", "ft/s"),
    "altitude": ("h", "ft"),
    "gamma": (r"\gamma", "rad"),
    "alpha": (r"\alpha", "rad"),
    "pitch_rate": ("Q", "rad/s"),
    "phi": (r"\phi", "1"),
    "delta_e": (r"\delta_e", "rad"),
    "delta_c": (r"\delta_c", "rad"),
    "velocity_dot": (r"\dot V", "ft/s^2"),
    "altitude_dot": (r"\dot h", "ft/s"),
    "gamma_dot": (r"\dot\gamma", "rad/s"),
    "alpha_dot": (r"\dot\alpha", "rad/s"),
    "pitch_rate_dot": (r"\dot Q", "rad/s^2"),
    "m": ("m", "slug/ft"),
    "i_yy": ("I_{yy}", "slug*ft"),
    "s": ("S", "ft"),
    "c_bar": (r"\bar c", "ft"),
    "z_t": ("z_T", "ft"),
    "g": ("g", "ft/s^2"),
    "density": (r"\rho", "slug/ft^3"),
    "dynamic_pressure": (r"\bar q", "lb/ft^2"),
    "thrust": ("T", "lb/ft"),
    "lift": ("L", "lb/ft"),
    "drag": ("D", "lb/ft"),
    "pitching_moment": ("M", "lb"),
    "c_t_phi_fit": (r"C_{T,\phi}", "1"),
    "c_t_fit": ("C_T", "1"),
    "c_l_fit": ("C_L", "1"),
    "c_d_fit": ("C_D", "1"),
    "c_m_fit": ("C_M", "1"),
    "c_n_fit": ("C_{{N_{i}}}", "(ft/slug)^0.5"),
    "omega": (r"\omega_{i}", "rad/s"),
    "zeta": (r"\zeta_{i}", "1"),
    "n": ("N_{i}", f"{FLEXIBLE}/s^2"),
    "n_d": ("N_{i}^d", f"{FLEXIBLE}/s^2"),
    "t": ("t", "s"),
    "tau": (r"\tau", "s"),
    "dt": ("dt", "s"),
    "dw": ("dw", "s^0.5"),
    "laplace_s": ("s", "1/s"),
    "x_1": ("x_1", FLEXIBLE),
    "x_2": ("x_2", f"{FLEXIBLE}/s"),
    "x_1_dot": (r"\dot x_1", f"{FLEXIBLE}/s"),
    "x_2_dot": (r"\dot x_2", f"{FLEXIBLE}/s^2"),
    "x_10": ("x_{{10}}", FLEXIBLE),
    "x_20": ("x_{{20}}", f"{FLEXIBLE}/s"),
    "u": ("u", f"{FLEXIBLE}/s^2"),
    "b_1": ("B_1", "s"),
    "b_2": ("B_2", "1"),
    "sigma": (r"\sigma_{i}", f"{FLEXIBLE}/s^1.5"),
    "xi": (r"\xi", "1/s^0.5"),
    "xi_i": (r"\xi_{i}", f"{FLEXIBLE}/s^2"),
    "c": ("c", "1/s^0.5"),
    "a": ("a", "1/s"),
    "b": ("b", f"{FLEXIBLE}/s^0.5"),
    "chi": (r"\chi_{i}", FLEXIBLE),
    "chi_dot": (r"\dot\chi_{i}", f"{FLEXIBLE}/s"),
    "d_chi": (r"d\chi_{i}", FLEXIBLE),
    "eta_hat": (r"\hat\eta_{i}", FLEXIBLE),
    "w_gamma": (r"w_\gamma", "rad"),
    "w_alpha": (r"w_\alpha", "rad"),
    "w_q": ("w_Q", "rad/s"),
}

# Matrix elements have the units of row over column of (eta, eta_dot), by powers of a second.
_ELEMENTS = {"11": 0, "12": 1, "21": -1, "22": 0}
_MATRICES = {
    "a": ("A_{{{ij}}}", -1),
    "transition": (r"\bigl(e^{{\mathbf A t}}\bigr)_{{{ij}}}", 0),
    "e": ("E_{{{ij}}}", 0),
    "pencil": (r"\bigl(s\mathbf I - \mathbf A\bigr)_{{{ij}}}", -1),
    "resolvent": (r"\bigl((s\mathbf I - \mathbf A)^{{-1}}\bigr)_{{{ij}}}", 1),
}

_ROWS = {"V": ("V", "ft/s^2"), "gamma": (r"\gamma", "rad/s"), "alpha": (r"\alpha", "rad/s"), "Q": ("Q", "rad/s^2")}
# What each function multiplies, and the units of the row divided by it.
_CONTROLS = {"V": "1", "gamma": "rad", "alpha": "rad/s", "Q": "rad"}
_SPANWISE = {"V": "1", "gamma": "1", "alpha": "1", "Q": "ft"}

_MONOMIAL = re.compile(r"(phi|alpha|delta_e|delta_c|eta|0)(?:_(\d))?(?:_|$)")
_MONOMIAL_LATEX = {"delta_e": r"\delta_e", "delta_c": r"\delta_c", "eta": r"\eta_{i}", "0": "0"}
_FITS = {"t": "C_T", "l": "C_L", "d": "C_D", "m": "C_M", "n": "N_{i}"}
_CURVE_FIT = re.compile(r"c_([tldmn])_(?!fit$|phi_fit$)(.+)")


def curve_fit(name: str) -> str | None:
    """The curve fit that a coefficient belongs to (`t`, `l`, `d`, `m`, `n`); None for any other name."""
    found = _CURVE_FIT.fullmatch(name)
    return found[1] if found else None


def _per_second(power: float) -> str:
    if power == 0:
        return "1"
    base = "s" if abs(power) == 1 else f"s^{abs(power):g}"
    return base if power > 0 else f"1/{base}"


def _eta_table() -> dict[str, tuple[str, str]]:
    found = {
        "eta": (r"\eta_{i}", FLEXIBLE),
        "eta_dot": (r"\dot\eta_{i}", f"{FLEXIBLE}/s"),
        "eta_ddot": (r"\ddot\eta_{i}", f"{FLEXIBLE}/s^2"),
    }
    for part in ("d", "n"):
        found |= {
            f"eta_{part}": (rf"\eta_{{i}}^{part}", FLEXIBLE),
            f"eta_{part}_dot": (rf"\dot\eta_{{i}}^{part}", f"{FLEXIBLE}/s"),
            f"eta_{part}_ddot": (rf"\ddot\eta_{{i}}^{part}", f"{FLEXIBLE}/s^2"),
            f"eta_{part}_0": (rf"\eta_{{{{{{i}}0}}}}^{part}", FLEXIBLE),
            f"eta_{part}_dot_0": (rf"\dot\eta_{{{{{{i}}0}}}}^{part}", f"{FLEXIBLE}/s"),
        }
    return found


def _matrix_table() -> dict[str, tuple[str, str]]:
    return {
        f"{name}_{ij}": (symbol.format(ij=ij), _per_second(extra + power))
        for name, (symbol, extra) in _MATRICES.items()
        for ij, power in _ELEMENTS.items()
    }


def _row_table() -> dict[str, tuple[str, str]]:
    found: dict[str, tuple[str, str]] = {}
    for row, (symbol, unit) in _ROWS.items():
        control = _CONTROLS[row]
        h_i = _INVERSE if _SPANWISE[row] == "1" else f"{_SPANWISE[row]}/(ft*slug)^0.5"
        found |= {
            f"f_{row}": (f"f_{symbol}", unit),
            f"delta_f_{row}": (rf"\Delta f_{symbol}", unit),
            f"g_{row}": (f"g_{symbol}", unit if control == "1" else f"{unit}/({control})"),
            f"h_{row}": (rf"h_{symbol}", f"{unit}/(ft*slug)^0.5"),
            f"h_{row}_i": (rf"h_{symbol}^{{i}}", h_i),
            f"H_{row}": (f"H_{symbol}", f"{unit}/rad"),
            f"f_{row}_eta": (rf"f_{symbol}^\eta", unit),
        }
    return found


_TABLE = _PLAIN | _eta_table() | _matrix_table() | _row_table()


def latex(name: str, mode: str = "i") -> str:
    """The LaTeX symbol of a name, with the index of the flexible mode put in."""
    if name in _TABLE:
        return _TABLE[name][0].replace("{i}", mode).replace("{{", "{").replace("}}", "}")
    fit = _CURVE_FIT.fullmatch(name)
    if fit is None:
        raise KeyError(f"the audit knows no symbol `{name}`")
    above = ""
    for word, power in _MONOMIAL.findall(fit[2]):
        symbol = _MONOMIAL_LATEX.get(word, rf"\{word}").replace("{i}", mode)
        above += symbol + (f"^{power}" if power else "") + " "
    return f"{_FITS[fit[1]].replace('{i}', mode)}^{{{above.strip()}}}"


def unit(name: str) -> str:
    """The unit of a name; a curve-fit coefficient is a number, but for those of or with a flexible mode."""
    if name in _TABLE:
        return _TABLE[name][1]
    if curve_fit(name) is None:
        raise KeyError(f"the audit knows no symbol `{name}`")
    if name.endswith("_eta"):
        return _INVERSE
    return "(ft/slug)^0.5" if name.startswith("c_n_") else "1"
