"""(27)-(35) as the paper prints them, with only the misprints corrected."""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy
from sympy import Expr

from .modes import static_deflection
from .names import Names, symbol
from .table import Table
from .vehicle import gravity_turn, pressure_force, sine_and_cosine, turning_rate

DRIVES = {
    "V": ("velocity", "input", "phi"),
    "gamma": ("gamma", "state", "alpha"),
    "alpha": ("alpha", "state", "pitch_rate"),
    "Q": ("pitch_rate", "input", "delta_e"),
}
"""For each part's suffix: the row, and kind and name of what g multiplies."""


@dataclass(frozen=True)
class Channel:
    """The parts of one row: ``f`` (with ``f_eta``), ``g``, ``h`` by mode and ``H``."""

    f: Expr
    f_eta: Expr
    g: Expr
    h: Mapping[int, Expr]
    big_h: Expr


def printed_rows(table: Table, names: Names, forces: Mapping[int, Expr]) -> dict[str, Expr]:
    """Rigid rows of (27) without Delta f."""
    rows = {"altitude": symbol("state", "velocity") * sympy.sin(symbol("state", "gamma"))}
    for suffix, channel in printed_channels(table, names, forces).items():
        row, kind, name = DRIVES[suffix]
        chi = (slope * symbol("state", f"chi_{i}") for i, slope in channel.h.items())
        rows[row] = channel.f + channel.g * symbol(kind, name) + sympy.Add(*chi)
    return rows


def printed_channels(table: Table, names: Names, forces: Mapping[int, Expr]) -> dict[str, Channel]:
    """The four channels of (28)-(35), each part by name."""
    write = _Writer(table, names, forces)
    return {"V": write.speed(), "gamma": write.turn(1), "alpha": write.turn(-1), "Q": write.pitch()}


class _Writer:
    """Writes the parts; ``c`` is a coefficient of the table, 0 where the table has none."""

    def __init__(self, table: Table, names: Names, forces: Mapping[int, Expr]) -> None:
        self._table = table
        self._names = names
        self._deflections = {i: static_deflection(i, force) for i, force in forces.items()}
        self._alpha, self._phi = symbol("state", "alpha"), symbol("input", "phi")
        self._sine, self._cosine = sine_and_cosine(names)
        self._weight, self._falling = gravity_turn()
        ratio = self.c("C_L", delta_e=1) / symbol("parameter", "c_l_delta_c")
        self._slaving = -symbol("parameter", "canard_slaving") * ratio

    def c(self, quantity: str, **powers: int) -> Expr:
        for term in self._table.quantities.get(quantity, ()):
            if dict(term.powers) == powers:
                return symbol("parameter", term.parameter)
        return sympy.Integer(0)

    def eta(self, quantity: str, mode: int) -> Expr:
        return self.c(quantity, **{f"eta_{mode}": 1})

    def channel(self, f: Expr, g: Expr, h: Mapping[int, Expr], big_h: Expr) -> Channel:
        """Collect the parts of a row; the sum over modes is named, as it stands alone as f_eta too."""
        named = {i: self._names.name(f"h_{i}", slope) for i, slope in h.items()}
        f_eta = self._names.name("f_eta", sympy.Add(*(named[i] * self._deflections[i] for i in named)))
        return Channel(self._names.name("f", f + f_eta), f_eta, self._names.name("g", g), named, big_h)

    def speed(self) -> Channel:
        """(28), (29)."""
        force = pressure_force(self._names) / symbol("parameter", "m")
        alpha, phi, cosine = self._alpha, self._phi, self._cosine
        elevator = self.c("C_D", delta_e=1) + self.c("C_D", delta_c=1) * self._slaving
        thrust = cosine * (self.c("C_T", alpha=1) * alpha + self.c("C_T"))
        drag = self.c("C_D", alpha=1) * alpha + elevator * symbol("input", "delta_e") + self.c("C_D")
        slope = self.c("C_T", phi=1, alpha=1)
        return self.channel(
            f=force * (thrust - drag) - self._weight,
            g=force * cosine * (slope * alpha + self.c("C_T", phi=1)),
            h={i: force * (cosine * self.eta("C_T", i) - self.eta("C_D", i)) for i in self._deflections},
            big_h=force * (cosine * (self.c("C_T", alpha=1) + slope * phi) - self.c("C_D", alpha=1)),
        )

    def turn(self, sign: int) -> Channel:
        """(30), (31) with `sign` 1, (32), (33) with -1."""
        flow, sine, alpha, phi = turning_rate(self._names), self._sine, self._alpha, self._phi
        slope = self.c("C_L", alpha=1) + sine * (self.c("C_T", phi=1, alpha=1) * phi + self.c("C_T", alpha=1))
        rest = self.c("C_L") + sine * (self.c("C_T", phi=1) * phi + self.c("C_T"))
        h = {i: sign * flow * (sine * self.eta("C_T", i) + self.eta("C_L", i)) for i in self._deflections}
        if sign > 0:
            return self.channel(flow * rest - self._falling, flow * slope, h, flow * slope)
        return self.channel(-flow * (rest + slope * alpha) + self._falling, sympy.Integer(1), h, -flow * slope)

    def pitch(self) -> Channel:
        """(34), (35)."""
        force = pressure_force(self._names) / symbol("parameter", "i_yy")
        alpha, phi = self._alpha, self._phi
        arm, chord = symbol("parameter", "z_t"), symbol("parameter", "c_bar")
        slope = self.c("C_T", phi=1, alpha=1) * phi + self.c("C_T", alpha=1)
        thrust = slope * alpha + self.c("C_T", phi=1) * phi + self.c("C_T")
        moment = self.c("C_M", alpha=2) * alpha**2 + self.c("C_M", alpha=1) * alpha + self.c("C_M")
        elevator = self.c("C_M", delta_e=1) + self.c("C_M", delta_c=1) * self._slaving
        return self.channel(
            f=force * (arm * thrust + chord * moment),
            g=force * chord * elevator,
            h={i: force * (arm * self.eta("C_T", i) + chord * self.eta("C_M", i)) for i in self._deflections},
            big_h=force * (chord * self.c("C_M", alpha=1) + arm * slope),
        )
