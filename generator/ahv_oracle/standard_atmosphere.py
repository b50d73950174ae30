"""The US Standard Atmosphere 1976 by its definition: layers of geopotential altitude, and hydrostatic balance.

The standard defines sea level, the layers with their temperature gradients, and the constants below; what it prints
follows. Here the hydrostatic equation is integrated over the temperature, without the closed forms that a model has.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import mpmath

# mpmath has no types.
Number = Any

# Gas constant in J/(kmol K), molar mass of air in kg/kmol, gravity in m/s^2, ratio of specific heats.
GAS, MOLAR_MASS, GRAVITY, HEATS = "8314.32", "28.9644", "9.80665", "1.4"
# Radius of the Earth for geopotential altitudes, m; temperature, K, and pressure, Pa, at sea level.
RADIUS, TEMPERATURE, PRESSURE = "6356766", "288.15", "101325"
# Of each layer: its base in m of geopotential altitude, and its temperature gradient in K/m.
LAYERS = (
    ("0", "-0.0065"),
    ("11000", "0"),
    ("20000", "0.001"),
    ("32000", "0.0028"),
    ("47000", "0"),
    ("51000", "-0.0028"),
    ("71000", "-0.002"),
)
TOP = "84852"


def temperature(height: Number) -> Number:
    """Molecular-scale temperature in K at a geopotential altitude in m."""
    found = mpmath.mpf(TEMPERATURE)
    for (base, gradient), (end, _) in pairwise((*LAYERS, (TOP, "0"))):
        within = min(max(mpmath.mpf(height), mpmath.mpf(base)), mpmath.mpf(end)) - mpmath.mpf(base)
        found += mpmath.mpf(gradient) * within
    return found


def air(height: Number) -> tuple[float, float, float, float]:
    """Temperature in K, pressure in Pa, density in kg/m^3, speed of sound in m/s at a geopotential altitude in m."""
    with mpmath.workdps(30):
        specific = mpmath.mpf(GAS) / mpmath.mpf(MOLAR_MASS)
        # The integrand has kinks at the bases.
        kinks = [mpmath.mpf(base) for base, _ in LAYERS if mpmath.mpf(base) < height]
        fall = mpmath.quad(lambda h: 1 / temperature(h), [*kinks, mpmath.mpf(height)]) if height else mpmath.mpf(0)
        here = temperature(height)
        pressure = mpmath.mpf(PRESSURE) * mpmath.exp(-mpmath.mpf(GRAVITY) / specific * fall)
        density = pressure / (specific * here)
        return float(here), float(pressure), float(density), float(mpmath.sqrt(mpmath.mpf(HEATS) * specific * here))
