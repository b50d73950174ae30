"""The reduction of a flexible mode to coloured noise, (18)-(26), in the three ways that `reduction` names."""

from __future__ import annotations

import casadi as ca

from ..model import Model
from ..schema import Choice, Option, switch
from .flexible import FLEXIBLE, of, subscript

REDUCTION = Choice(
    "reduction",
    "Reduction",
    "reduction of a flexible mode to coloured noise",
    (
        switch("variance_matching", "s_v", "share of the reduction that matches decay rate and variance"),
        switch("moment_matching", "s_m", "share of the reduction that matches variance and gain at zero frequency"),
    ),
    (
        Option("printed", "decay rate and gain at zero frequency, as (23) has it; the variance is off", (0.0, 0.0)),
        Option("variance", "decay rate and variance; the spectrum at zero frequency is off", (1.0, 0.0)),
        Option("moment", "variance and spectrum at zero frequency; fast for small damping", (0.0, 1.0)),
    ),
)
SECTION = "Coloured noise"


def define_decay(m: Model, suffix: str = "") -> ca.SX:
    """The decay rate a of (18), by (23) or by matching moments."""
    omega, zeta, moment = (m.parameter(name) for name in (f"omega{suffix}", f"zeta{suffix}", "moment_matching"))
    printed = zeta * omega
    # Not a difference from the printed one: in that the other rate would drown where the damping is large.
    return m.graph.define(
        f"chi_decay{suffix}",
        printed * (1 - moment) + moment * (omega / (2 * zeta)),
        symbol=f"a{subscript(suffix)}",
        unit="1/s",
        doc=f"decay rate of the coloured noise{of(suffix)}",
        equation="(23)",
        section=SECTION,
    )


def define_rate(m: Model, decay: ca.SX, suffix: str = "") -> ca.SX:
    """The drift of chi, (27)."""
    return m.graph.define(
        f"chi_rate{suffix}",
        -decay * m[f"chi{suffix}"],
        symbol=rf"\dot\chi{subscript(suffix)}",
        unit=f"{FLEXIBLE}/s",
        doc=f"drift of the coloured noise{of(suffix)}; (24) and (26) omit the factor chi",
        equation="(27)",
        section=SECTION,
    )


def define_diffusion(m: Model, suffix: str = "") -> ca.SX:
    """The diffusion b of (18), by (23) or by matching variances or moments."""
    omega, zeta, sigma = (m.parameter(f"{name}{suffix}") for name in ("omega", "zeta", "sigma"))
    variance, moment = m.parameter("variance_matching"), m.parameter("moment_matching")
    share = m.graph.define(
        f"chi_share{suffix}",
        zeta * (1 - variance - moment) + variance / ca.sqrt(2) + moment / (2 * zeta),
        symbol=rf"\beta{subscript(suffix)}",
        unit="1",
        doc=f"diffusion of the coloured noise{of(suffix)} over sigma/omega",
        equation="(23)",
        section=SECTION,
    )
    return m.graph.define(
        f"chi_diffusion{suffix}",
        share * sigma / omega,
        symbol=f"b{subscript(suffix)}",
        unit=f"{FLEXIBLE}/s^0.5",
        doc=f"diffusion of the coloured noise{of(suffix)}",
        equation="(23)",
        section=SECTION,
    )
