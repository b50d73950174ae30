"""Models of the air that a family may choose from: exponential, and the US Standard Atmosphere 1976.

A family adds the parameters to its tables (`family.parameters("air", *US_1976)`) and calls the function in a section
of its equations. The numbers of a standard stand in the table like all others; `docs/families.md` has them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca

from .model import Model
from .schema import NOT_ZERO, POSITIVE, Parameter

EXPONENTIAL = (
    Parameter("rho_0", r"\rho_0", "slug/ft^3", "air density at the reference altitude", POSITIVE),
    Parameter("h_0", "h_0", "ft", "reference altitude of the air density"),
    Parameter("h_s", "h_s", "ft", "scale height of the air density", POSITIVE),
)

_LAYERS = range(7)
_ISOTHERMAL = (1, 4)


def _bases_of_layers() -> list[Parameter]:
    """The altitudes at which layers begin, each above that below."""
    found: list[Parameter] = []
    for i in _LAYERS[1:]:
        doc = f"geopotential altitude of the base of layer {i}"
        must, below = (None, found[-1]) if found else (POSITIVE, None)
        found.append(Parameter(f"H_{i}", f"H_{i}", "ft", doc, must, below))
    return found


US_1976 = (
    Parameter("T_0", "T_0", "K", "air temperature at sea level", POSITIVE),
    Parameter("p_0", "p_0", "lb/ft^2", "air pressure at sea level", POSITIVE),
    Parameter("R_air", "R_a", "ft^2/s^2/K", "specific gas constant of air", POSITIVE),
    Parameter("kappa_air", r"\kappa_a", "1", "ratio of the specific heats of air", POSITIVE),
    Parameter("g_0", "g_0", "ft/s^2", "acceleration of gravity of geopotential altitudes", POSITIVE),
    Parameter("r_0", "r_0", "ft", "radius of the Earth of geopotential altitudes", POSITIVE),
    *_bases_of_layers(),
    *(
        Parameter(f"lapse_{i}", f"L_{i}", "K/ft", f"temperature gradient of layer {i}", NOT_ZERO)
        for i in _LAYERS
        if i not in _ISOTHERMAL
    ),
)


@dataclass(frozen=True)
class Air:
    """The air at an altitude."""

    temperature: ca.SX
    pressure: ca.SX
    density: ca.SX
    speed_of_sound: ca.SX


def exponential_density(model: Model, altitude: ca.SX) -> ca.SX:
    """The density of an exponential atmosphere at an altitude, by the parameters `EXPONENTIAL`; defines `density`."""
    density = model["rho_0"] * ca.exp((model["h_0"] - altitude) / model["h_s"])
    return model.define("density", density, r"\rho", "slug/ft^3", "air density")


def us_standard_atmosphere_1976(model: Model, altitude: ca.SX) -> Air:
    """The US Standard Atmosphere 1976 at a geometric altitude, by the parameters `US_1976`; defines all of `Air`.

    It is that of the standard up to 84.852 km geopotential altitude; beyond, and below sea level, the last and first
    layer go on. The temperature is the molecular-scale one, which is the kinetic one up to 80 km.
    """
    bases = _bases(model)
    ratio = model["r_0"] / (model["r_0"] + altitude)
    height = model.define("geopotential_altitude", ratio * altitude, "H", "ft", "geopotential altitude")
    chosen = [_of_layer(model, height, [base[i] for base in bases]) for i in range(5)]
    floor = model.define("layer_floor", chosen[0], "H_b", "ft", "base of the layer")
    warmth = model.define("layer_temperature", chosen[1], "T_b", "K", "temperature at the base of the layer")
    lapse = model.define("layer_lapse", chosen[2], "L_b", "K/ft", "temperature gradient of the layer")
    weight = model.define("layer_pressure", chosen[3], "p_b", "lb/ft^2", "pressure at the base of the layer")
    power = model.define("layer_exponent", chosen[4], "n_b", "1", "exponent of the layer, 0 where it is isothermal")
    temperature = model.define("temperature", warmth + lapse * (height - floor), "T", "K", "air temperature")
    # One of the two factors is 1: that of a layer with a gradient, and that of an isothermal one.
    decay = _of_layer(model, height, [base[5] for base in bases])
    decay = model.define("layer_decay", decay, "k_b", "1/ft", "decay of the pressure, 0 where there is a gradient")
    factor = (temperature / warmth) ** (-power) * ca.exp(-decay * (height - floor))
    pressure = model.define("pressure", weight * factor, "p", "lb/ft^2", "air pressure")
    density = pressure / (model["R_air"] * temperature)
    density = model.define("density", density, r"\rho", "slug/ft^3", "air density")
    sound = ca.sqrt(model["kappa_air"] * model["R_air"] * temperature)
    sound = model.define("speed_of_sound", sound, "a", "ft/s", "speed of sound")
    return Air(temperature, pressure, density, sound)


def _of_layer(model: Model, height: ca.SX, values: Sequence[ca.SX]) -> ca.SX:
    """Of a value for each layer that of the layer in which `height` lies."""
    found = values[-1]
    for i in reversed(_LAYERS[1:]):
        found = ca.if_else(height < model[f"H_{i}"], values[i - 1], found)
    return found


def _bases(model: Model) -> list[tuple[ca.SX, ...]]:
    """Of each layer: base, temperature, gradient and pressure there, exponent, decay; of parameters alone."""
    found: list[tuple[ca.SX, ...]] = []
    floor, temperature, pressure = ca.SX(0), model["T_0"], model["p_0"]
    for i in _LAYERS:
        is_isothermal = i in _ISOTHERMAL
        lapse = ca.SX(0) if is_isothermal else model[f"lapse_{i}"]
        power = ca.SX(0) if is_isothermal else model["g_0"] / (model["R_air"] * lapse)
        decay = model["g_0"] / (model["R_air"] * temperature) if is_isothermal else ca.SX(0)
        found.append((floor, temperature, lapse, pressure, power, decay))
        if i == _LAYERS[-1]:
            break
        next_floor = model[f"H_{i + 1}"]
        ratio = ca.exp(-decay * (next_floor - floor)) if is_isothermal else ca.SX(1)
        if not is_isothermal:
            warmer = temperature + lapse * (next_floor - floor)
            warmer = model.define(
                f"base_temperature_{i + 1}", warmer, f"T_{i + 1}", "K", f"temperature at the base of layer {i + 1}"
            )
            ratio, temperature = (warmer / temperature) ** (-power), warmer
        name = f"base_pressure_{i + 1}"
        pressure = model.define(
            name, pressure * ratio, f"p_{i + 1}", "lb/ft^2", f"pressure at the base of layer {i + 1}"
        )
        floor = next_floor
    return found
