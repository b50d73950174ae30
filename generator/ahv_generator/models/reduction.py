"""The reduction of a flexible mode to coloured noise, (18)-(26), in the three ways that `reduction` names."""

from __future__ import annotations

import casadi as ca

from ..model import Model
from ..schema import FLEXIBLE

SECTION = "Coloured noise"


def define_decay(m: Model, suffix: str = "", of: str = "") -> ca.SX:
    """The decay rate a of (18), by (23) or by matching moments."""
    omega, zeta, moment = (m.parameter(name) for name in (f"omega{suffix}", f"zeta{suffix}", "moment_matching"))
    printed = zeta * omega
    # Not a difference from the printed one: in that the other rate would drown where the damping is large.
    return m.graph.define(
        f"chi_decay{suffix}",
        printed * (1 - moment) + moment * (omega / (2 * zeta)),
        symbol=f"a{suffix}",
        unit="1/s",
        doc=f"decay rate of the coloured noise{of}",
        equation="(23)",
        section=SECTION,
    )


def define_rate(m: Model, decay: ca.SX, suffix: str = "", of: str = "") -> ca.SX:
    """The drift of chi, (27)."""
    return m.graph.define(
        f"chi_rate{suffix}",
        -decay * m[f"chi{suffix}"],
        symbol=rf"\dot\chi{suffix}",
        unit=f"{FLEXIBLE}/s",
        doc=f"drift of the coloured noise{of}; (24) and (26) omit the factor chi",
        equation="(27)",
        section=SECTION,
    )


def define_diffusion(m: Model, suffix: str = "", of: str = "") -> ca.SX:
    """The diffusion b of (18), by (23) or by matching variances or moments."""
    omega, zeta, sigma = (m.parameter(f"{name}{suffix}") for name in ("omega", "zeta", "sigma"))
    variance, moment = m.parameter("variance_matching"), m.parameter("moment_matching")
    share = m.graph.define(
        f"chi_share{suffix}",
        zeta * (1 - variance - moment) + variance / ca.sqrt(2) + moment / (2 * zeta),
        symbol=rf"\beta{suffix}",
        unit="1",
        doc=f"diffusion of the coloured noise{of} over sigma/omega",
        equation="(23)",
        section=SECTION,
    )
    return m.graph.define(
        f"chi_diffusion{suffix}",
        share * sigma / omega,
        symbol=f"b{suffix}",
        unit=f"{FLEXIBLE}/s^0.5",
        doc=f"diffusion of the coloured noise{of}",
        equation="(23)",
        section=SECTION,
    )
