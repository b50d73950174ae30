"""Linear predictive control of the rigid COM, made of its linear system, on the vehicle that SciPy flies."""

import ahv
import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm, solve_discrete_are

STEP, HORIZON, END = 0.1, 20, 4.0


def main() -> None:
    """Print the angle of attack second by second, held and not."""
    model = ahv.com_rigid
    trim = model.trim()
    system = model.linearize(trim)
    n, m = system.B.shape
    # Zero-order hold.
    held = expm(np.block([[system.A, system.B], [np.zeros((m, n + m))]]) * STEP)
    a, b = held[:n, :n], held[:n, n:]
    q, r = np.diag([1e-2, 1e-4, 1e4, 2.5e3, 4e2]), np.diag([25.0, 400.0])
    last = solve_discrete_are(a, b, q, r)
    # x over the horizon is F x + G u; the cost is quadratic in u.
    powers = [np.linalg.matrix_power(a, k) for k in range(HORIZON + 1)]
    free = np.vstack(powers[1:])
    zero = np.zeros((n, m))
    forced = np.block([[powers[i - j] @ b if j <= i else zero for j in range(HORIZON)] for i in range(HORIZON)])
    weights = np.kron(np.eye(HORIZON), q)
    weights[-n:, -n:] = last
    gain = np.linalg.solve(forced.T @ weights @ forced + np.kron(np.eye(HORIZON), r), forced.T @ weights @ free)[:m]
    low, high = np.array(list(model.input_bounds.values())).T

    def fly(x: np.ndarray, u: np.ndarray) -> np.ndarray:
        return solve_ivp(lambda _, it: model.drift(it, u), (0.0, STEP), x, rtol=1e-8, atol=1e-8).y[:, -1]

    x = alone = trim.state.replace(alpha=trim.state.alpha + np.radians(0.5)).values
    for step in range(round(END / STEP) + 1):
        if step % 10 == 0:
            angles = np.degrees([x[3], alone[3]])
            print(f"{step * STEP:4.1f} s  controlled {angles[0]:8.4f} deg  alone {angles[1]:10.4f} deg")
        u = np.clip(trim.input.values - gain @ (x - trim.state.values), low, high)
        x, alone = fly(x, u), fly(alone, trim.input.values) if abs(alone[3]) < 1.0 else alone
    assert abs(x[3] - trim.state.alpha) < np.radians(0.2)


if __name__ == "__main__":
    main()
