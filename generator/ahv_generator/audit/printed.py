"""The printed equations (1)-(35) and Table 2 of the paper, transcribed as they stand, misprints included.

Everything else of the audit follows from these lines by computation. An expression is Python text over the names of
`symbols.py`. A flexible mode stands for all three: a sum over modes is written `modes(...)` of one of them. A matrix
equation is entered element by element.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Printed:
    """One printed equation, or one function or matrix element of it: `left` = `right`."""

    number: str
    name: str
    left: str
    right: str
    role: str = "result"  # `premise`: what the rest is derived from; `definition`: nothing to derive
    mode: str = "i"  # index of the flexible mode, as printed
    approximate: bool = False

    @property
    def key(self) -> tuple[str, str]:
        """Number and name, which tell the entry from all others."""
        return self.number, self.name


@dataclass(frozen=True)
class PrintedValue:
    """One row of Table 2: the value and the unit printed beside a symbol."""

    name: str
    value: str
    unit: str
    mode: str = "i"


def _read(text: str, role: str = "result", mode: str = "i") -> Iterator[Printed]:
    """The equations of a text: number, name, `:` and the left side if that is not the name, a sign, and the right side.

    The sign is `=`, `≈` of what is approximate, or `:=` of a definition. A line that begins with a blank goes on.
    """
    for line in re.sub(r"\n +", " ", text.strip()).splitlines():
        head, sign, right = re.split(r" (=|≈|:=) ", line)
        number, _, named = head.partition(" ")
        name, _, left = named.partition(": ")
        yield Printed(number, name, left or name, right, "definition" if sign == ":=" else role, mode, sign == "≈")


EQUATIONS: tuple[Printed, ...] = (
    *_read(
        """
(1) velocity_dot = (thrust*cos(alpha) - drag)/m - g*sin(gamma)
(1) altitude_dot = velocity*sin(gamma)
(1) gamma_dot = (lift + thrust*sin(alpha))/(m*velocity) - g/velocity*cos(gamma)
(1) alpha_dot = -(lift + thrust*sin(alpha))/(m*velocity) + pitch_rate + g/velocity*cos(gamma)
(1) pitch_rate_dot = pitching_moment/i_yy
(1) eta_ddot = -2*zeta*omega*eta_dot - omega**2*eta + n
(2) thrust = dynamic_pressure*s*(c_t_phi_fit*phi + c_t_fit + c_t_eta*eta)
(2) lift = dynamic_pressure*s*c_l_fit
(2) drag = dynamic_pressure*s*c_d_fit
(2) pitching_moment = z_t*thrust + dynamic_pressure*c_bar*s*c_m_fit
(2) n = dynamic_pressure*s*c_n_fit
(2) dynamic_pressure = density*velocity**2/2
(3) c_t_phi_fit = c_t_phi_alpha_3*alpha**3 + c_t_phi_alpha_2*alpha**2 + c_t_phi_alpha*alpha + c_t_phi
(3) c_t_fit = c_t_alpha_3*alpha**3 + c_t_alpha_2*alpha**2 + c_t_alpha*alpha + c_t_0
(3) c_l_fit = c_l_alpha*alpha + c_l_delta_e*delta_e + c_l_delta_c*delta_c + c_l_0 + c_l_eta*eta
(3) c_d_fit = c_d_alpha_2*alpha**2 + c_d_alpha*alpha + c_d_delta_e_2*delta_e**2 + c_d_delta_e*delta_e +
    c_d_delta_c_2*delta_c**2 + c_d_delta_c*delta_c + c_d_0 + c_d_eta*eta
(3) c_m_fit = c_m_alpha_2*alpha**2 + c_m_alpha*alpha + c_m_delta_e*delta_e + c_m_delta_c*delta_c + c_m_0 + c_m_eta*eta
(3) c_n_fit = c_n_alpha_2*alpha**2 + c_n_alpha*alpha + c_n_delta_e*delta_e + c_n_delta_c*delta_c + c_n_0
(4) delta_c = -c_l_delta_e/c_l_delta_c*delta_e
""",
        role="premise",
    ),
    *_read("""
(5) mode: eta_ddot + 2*zeta*omega*eta_dot + omega**2*eta = n
(6) n ≈ dynamic_pressure*s*(c_n_alpha_2*alpha**2 + c_n_alpha*alpha + c_n_delta_e*delta_e + c_n_delta_c*delta_c + c_n_0)
"""),
    *_read(
        """
(7) x_1_dot = x_2
(7) x_2_dot = n_d - 2*zeta*omega*x_2 - omega**2*x_1
(8) x_1_dot = a_11*x_1 + a_12*x_2 + b_1*u
(8) x_2_dot = a_21*x_1 + a_22*x_2 + b_2*u
(9) a_11 = 0
(9) a_12 = 1
(9) a_21 = -omega**2
(9) a_22 = -2*zeta*omega
(9) b_1 = 0
(9) b_2 = 1
(9) u = n_d
(10) x_1 = transition_11*x_10 + transition_12*x_20 + integral(transition_11(t - tau)*b_1*u(tau)) +
    integral(transition_12(t - tau)*b_2*u(tau))
(10) x_2 = transition_21*x_10 + transition_22*x_20 + integral(transition_21(t - tau)*b_1*u(tau)) +
    integral(transition_22(t - tau)*b_2*u(tau))
(11) transition_11 = inverse_laplace(resolvent_11)
(11) transition_12 = inverse_laplace(resolvent_12)
(11) transition_21 = inverse_laplace(resolvent_21)
(11) transition_22 = inverse_laplace(resolvent_22)
(12) pencil_11 = laplace_s
(12) pencil_12 = -1
(12) pencil_21 = omega**2
(12) pencil_22 = laplace_s + 2*zeta*omega
(12) resolvent_11 = (laplace_s + 2*zeta*omega)/(laplace_s**2 + 2*zeta*omega*laplace_s + omega**2)
(12) resolvent_12 = 1/(laplace_s**2 + 2*zeta*omega*laplace_s + omega**2)
(12) resolvent_21 = -omega**2/(laplace_s**2 + 2*zeta*omega*laplace_s + omega**2)
(12) resolvent_22 = laplace_s/(laplace_s**2 + 2*zeta*omega*laplace_s + omega**2)
(13) e_11 = cosh(omega*sqrt(zeta**2 - 1)*t) + zeta*sinh(omega*sqrt(zeta**2 - 1)*t)/sqrt(zeta**2 - 1)
(13) e_12 = sin(omega*sqrt(1 - zeta**2)*t)/(omega*sqrt(1 - zeta**2))
(13) e_21 = -omega*sin(omega*sqrt(1 - zeta**2)*t)/sqrt(1 - zeta**2)
(13) e_22 = cosh(omega*sqrt(zeta**2 - 1)*t) - zeta*sinh(omega*sqrt(zeta**2 - 1)*t)/sqrt(zeta**2 - 1)
(14) transition_11 = exp(-zeta*omega*t)*e_11
(14) transition_12 = exp(-zeta*omega*t)*e_12
(14) transition_21 = exp(-zeta*omega*t)*e_21
(14) transition_22 = exp(-zeta*omega*t)*e_22
(15) eta_d = n_d/omega**2 + exp(-zeta*omega*t)*(eta_d_0*e_11 + (eta_d_dot_0 + n_d*zeta/omega)*e_12 -
    n_d/omega**2*cos(omega*sqrt(1 - zeta**2)*t))
""",
        mode="1",
    ),
    *_read("""
(16) xi_i := sigma*xi
"""),
    *_read(
        """
(17) mode: eta_n_ddot + 2*zeta*omega*eta_n_dot + omega**2*eta_n = sigma*xi
(18) d_chi := -a*chi*dt + b*dw
(19) eta_n = sigma*c/omega**2 + exp(-zeta*omega*t)*(eta_n_0*e_11 + (eta_n_dot_0 + sigma*c*zeta/omega)*e_12 -
    sigma*c/omega**2*cos(omega*sqrt(1 - zeta**2)*t))
(20) chi: chi_dot + a*chi = b*c
(21) chi = b*c/a - exp(-a*t)*(b*c/a)
(22) a = zeta*omega
(22) steady: b*c/a = sigma*c/omega**2
(23) a = zeta*omega
(23) b = zeta*sigma/omega
(24) d_chi = -zeta*omega*dt + zeta*sigma/omega*dw
""",
        mode="1",
    ),
    *_read("""
(25) eta_hat ≈ n_d/omega**2 + chi
"""),
    *_read(
        """
(26) d_chi = -zeta*omega*dt + zeta*sigma/omega*dw
""",
        mode="1",
    ),
    *_read("""
(27) velocity_dot = f_V + g_V*phi + delta_f_V + h_V*chi + H_V*w_alpha
(27) altitude_dot = velocity*sin(gamma) + velocity*w_gamma
(27) gamma_dot = f_gamma + g_gamma*alpha + delta_f_gamma + h_gamma*chi + H_gamma*w_alpha
(27) alpha_dot = f_alpha + g_alpha*pitch_rate + delta_f_alpha + h_alpha*chi + H_alpha*w_alpha + w_q
(27) pitch_rate_dot = f_Q + g_Q*delta_e + delta_f_Q + h_Q*chi + H_Q*w_alpha
(27) chi_dot = -zeta*omega*chi + zeta*sigma/omega*xi
(28) f_V = dynamic_pressure*s/m*(cos(alpha)*(c_t_alpha*alpha + c_t_0) - c_d_alpha*alpha - (c_d_delta_e -
    c_d_delta_c*c_l_delta_e/c_l_delta_c)*delta_e - c_d_0) - g*sin(gamma) + f_V_eta
(28) g_V = dynamic_pressure*s/m*cos(alpha)*(c_t_phi_alpha*alpha + c_t_phi)
(28) h_V = dynamic_pressure*s/m*h_V_i
(28) H_V = dynamic_pressure*s/m*((cos(alpha)*c_t_alpha + c_t_phi_alpha*phi) - c_d_alpha)
(29) f_V_eta = dynamic_pressure*s/m*modes((cos(alpha)*c_t_eta - c_d_eta)*(n/omega**2))
(29) h_V_i = cos(alpha)*c_t_eta - c_d_eta
(30) f_gamma = dynamic_pressure*s/(m*velocity)*(c_l_0 + sin(alpha)*(c_t_phi*phi + c_t_0)) - g/velocity*cos(gamma) +
    f_gamma_eta
(30) g_gamma = dynamic_pressure*s/(m*velocity)*(c_l_alpha + c_t_phi_alpha*phi + c_t_alpha)
(30) h_gamma = dynamic_pressure*s/(m*velocity)*h_gamma_i
(30) H_gamma = dynamic_pressure*s/(m*velocity)*(c_l_alpha + sin(alpha)*phi*c_t_phi_alpha + sin(alpha)*c_t_alpha)
(31) f_gamma_eta = dynamic_pressure*s/(m*velocity)*modes((sin(alpha)*c_t_eta + c_l_eta)*(n/omega**2))
(31) h_gamma_i = sin(alpha)*c_t_eta + c_l_eta
(32) f_alpha = -dynamic_pressure*s/(m*velocity)*(c_l_0 + c_l_alpha*alpha + c_t_phi_alpha*phi*alpha + c_t_alpha*alpha
    + sin(alpha)*(c_t_phi*phi + c_t_0)) + g/velocity*cos(gamma) + f_alpha_eta
(32) g_alpha = 1
(32) h_alpha = dynamic_pressure*s/(m*velocity)*h_alpha_i
(32) H_alpha = -dynamic_pressure*s/(m*velocity)*(c_l_alpha + sin(alpha)*c_t_phi_alpha*phi + sin(alpha)*c_t_alpha)
(33) f_alpha_eta = dynamic_pressure*s/(m*velocity)*modes((c_l_eta - sin(alpha)*c_t_eta)*(n/omega**2))
(33) h_alpha_i = c_l_eta - sin(alpha)*c_t_eta
(34) f_Q = dynamic_pressure*s/i_yy*(z_t*(c_t_phi_alpha*phi*alpha + c_t_phi*phi + c_t_alpha*alpha + c_t_0) +
    c_bar*(c_m_alpha_2*alpha**2 + c_m_alpha*alpha + c_m_0)) + f_Q_eta
(34) g_Q = dynamic_pressure*s*c_bar/i_yy*(c_m_delta_e - c_m_delta_e*c_l_delta_e/c_l_delta_e)
(34) h_Q = dynamic_pressure*s/(m*velocity)*h_Q_i
(34) H_Q = dynamic_pressure*c_bar*s/i_yy*c_m_alpha
(35) f_Q_eta = dynamic_pressure*s/i_yy*modes((z_t*c_t_eta + c_bar*c_m_eta)*(n/omega**2))
(35) h_Q_i = z_t*c_t_eta + c_bar*c_m_eta
"""),
)

# Row by row as printed; a value without a unit is a pure number.
TABLE_2: tuple[PrintedValue, ...] = (
    PrintedValue("velocity", "85000", "ft"),
    PrintedValue("altitude", "7702.08", "ft/s"),
    PrintedValue("gamma", "0", "deg"),
    PrintedValue("alpha", "1.5153", "deg"),
    PrintedValue("pitch_rate", "0", "deg/s"),
    PrintedValue("eta", "0.827", "ft", "1"),
    PrintedValue("eta", "0.185", "ft", "2"),
    PrintedValue("eta", "0.029", "ft", "3"),
    PrintedValue("phi", "0.2514", "1"),
    PrintedValue("delta_e", "11.4635", "1"),
)
