"""The reduction of a flexible mode to coloured noise, (18)-(26), in the three ways that `reduction` names."""

from __future__ import annotations

from ..modelling import Choice, Expr, Model, Option, sqrt, switch
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


def define_decay(model: Model, suffix: str = "") -> Expr:
    """The decay rate a of (18), by (23) or by matching moments."""
    omega, zeta, moment = model.symbols(f"omega{suffix}", f"zeta{suffix}", "moment_matching")
    printed = zeta * omega
    # Not a difference from the printed one: in that the other rate would drown where the damping is large.
    decay = printed * (1 - moment) + moment * (omega / (2 * zeta))
    doc = f"decay rate of the coloured noise{of(suffix)}"
    with model.section(SECTION, "(23)"):
        return model.define(f"chi_decay{suffix}", decay, f"a{subscript(suffix)}", "1/s", doc)


def define_rate(model: Model, decay: Expr, suffix: str = "") -> Expr:
    """The drift of chi, (27)."""
    rate = -decay * model[f"chi{suffix}"]
    doc = f"drift of the coloured noise{of(suffix)}; (24) and (26) omit the factor chi"
    with model.section(SECTION, "(27)"):
        return model.define(f"chi_rate{suffix}", rate, rf"\dot\chi{subscript(suffix)}", f"{FLEXIBLE}/s", doc)


def define_diffusion(model: Model, suffix: str = "") -> Expr:
    """The diffusion b of (18), by (23) or by matching variances or moments."""
    omega, zeta, sigma = model.symbols(f"omega{suffix}", f"zeta{suffix}", f"sigma{suffix}")
    variance, moment = model.symbols("variance_matching", "moment_matching")
    with model.section(SECTION, "(23)"):
        share = zeta * (1 - variance - moment) + variance / sqrt(2) + moment / (2 * zeta)
        doc = f"diffusion of the coloured noise{of(suffix)} over sigma/omega"
        share = model.define(f"chi_share{suffix}", share, rf"\beta{subscript(suffix)}", "1", doc)
        doc = f"diffusion of the coloured noise{of(suffix)}"
        diffusion = share * sigma / omega
        return model.define(f"chi_diffusion{suffix}", diffusion, f"b{subscript(suffix)}", f"{FLEXIBLE}/s^0.5", doc)
