# mypy: disable-error-code="import-not-found, import-untyped, untyped-decorator"
"""JAX and diffrax on CasADi's instructions as Python: 64 bits, vectorised over points and members, compiled."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, ClassVar

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from printed import compiled
from turns import Array, Job, Problem, moments, moments_of_sums, serve

State = tuple[jax.Array, jax.Array, jax.Array]

# Members that are stepped together.
BLOCK = 1024

jax.config.update("jax_enable_x64", True)


def row_by_row(problem: Problem, name: str) -> Callable[..., Any]:
    """A function of CasADi with one output, as an array."""
    function = compiled(problem.function(name), jnp, stores=False)

    def evaluate(*arguments: jax.Array) -> jax.Array:
        return jnp.stack([jnp.asarray(value, dtype=jnp.float64) for value in function(*arguments)])

    return evaluate


def evaluation(problem: Problem, model: str, of: Callable[..., Any]) -> Job:
    """A function at all points at once, points along the last axis."""
    states, inputs = (jnp.asarray(problem.array("points", model, key).T) for key in ("states", "inputs"))
    p = jnp.asarray(problem.array("parameters", model))
    batched = jax.jit(jax.vmap(of, in_axes=(1, 1, None), out_axes=-1))

    def values(found: tuple[jax.Array, ...]) -> Array:
        count = states.shape[1]
        return np.concatenate([np.asarray(leaf).reshape(-1, count) for leaf in jax.tree.leaves(found)]).T.ravel()

    return Job(lambda _: jax.block_until_ready(batched(states, inputs, p)), values)


def drift(problem: Problem) -> Job:
    """Drift of DCOM."""
    return evaluation(problem, "dcom", row_by_row(problem, "dcom_drift"))


def drift_jacobians(problem: Problem) -> Job:
    """Drift of DCOM and both Jacobians, by JAX's forward mode."""
    rate = row_by_row(problem, "dcom_drift")

    def twice(x: jax.Array, u: jax.Array, p: jax.Array) -> tuple[jax.Array, jax.Array]:
        value = rate(x, u, p)
        return value, value

    def both(x: jax.Array, u: jax.Array, p: jax.Array) -> tuple[jax.Array, ...]:
        (f_x, f_u), f = jax.jacfwd(twice, argnums=(0, 1), has_aux=True)(x, u, p)
        return f, f_x, f_u

    return evaluation(problem, "dcom", both)


def drift_diffusion(problem: Problem) -> Job:
    """Drift and diffusion of SDCOM."""
    function = compiled(problem.function("sdcom_drift_diffusion"), jnp, stores=False)

    def both(x: jax.Array, u: jax.Array, p: jax.Array) -> tuple[jax.Array, ...]:
        outputs = function(x, u, p)
        return tuple(jnp.stack([jnp.asarray(value, dtype=jnp.float64) for value in output]) for output in outputs)

    return evaluation(problem, "sdcom", both)


def runge_kutta(problem: Problem) -> Job:
    """Flights of DCOM side by side, each a vector: faster here than one array a component."""
    rate = row_by_row(problem, "dcom_drift")
    start, u, p, dt = (jnp.asarray(it) for it in problem.flight("rk4"))
    steps, (h,) = problem.count("rk4", "steps"), dt
    starts = jnp.tile(start, (problem.count("rk4", "batch"), 1))

    @jax.jit
    @partial(jax.vmap, in_axes=(0, None, None))
    def fly(x: jax.Array, u: jax.Array, p: jax.Array) -> jax.Array:
        def step(_: int, x: jax.Array) -> jax.Array:
            k1 = rate(x, u, p)
            k2 = rate(x + h / 2 * k1, u, p)
            k3 = rate(x + h / 2 * k2, u, p)
            k4 = rate(x + h * k3, u, p)
            return x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)

        end: jax.Array = lax.fori_loop(0, steps, step, x)
        return end

    return Job(lambda _: jax.block_until_ready(fly(starts, u, p)), lambda ends: np.asarray(ends)[0])


class _RungeKutta(diffrax.AbstractERK):  # type: ignore[misc]
    """The classical method, which diffrax has no solver for."""

    tableau: ClassVar[diffrax.ButcherTableau] = diffrax.ButcherTableau(
        c=np.array([0.5, 0.5, 1.0]),
        b_sol=np.array([1 / 6, 1 / 3, 1 / 3, 1 / 6]),
        b_error=np.zeros(4),
        a_lower=(np.array([0.5]), np.array([0.0, 0.5]), np.array([0.0, 0.0, 1.0])),
    )
    interpolation_cls: ClassVar[Callable[..., Any]] = diffrax.ThirdOrderHermitePolynomialInterpolation.from_k

    def order(self, terms: diffrax.AbstractTerm) -> int:
        return 4


def _solve(
    terms: diffrax.AbstractTerm, solver: diffrax.AbstractSolver, start: jax.Array, dt: float, steps: int
) -> jax.Array:
    """The end of a flight by diffrax at a fixed step."""
    solution = diffrax.diffeqsolve(
        terms,
        solver,
        t0=0.0,
        t1=steps * dt,
        dt0=None,
        y0=start,
        stepsize_controller=diffrax.StepTo(ts=jnp.arange(steps + 1) * dt),
        saveat=diffrax.SaveAt(t1=True),
        max_steps=steps,
        adjoint=diffrax.ForwardMode(),
    )
    return solution.ys[-1]


def diffrax_runge_kutta(problem: Problem) -> Job:
    """Flights of DCOM side by side, by diffrax."""
    rate = row_by_row(problem, "dcom_drift")
    start, u, p, _ = (jnp.asarray(it) for it in problem.flight("rk4"))
    steps = problem.count("rk4", "steps")
    starts = jnp.tile(start, (problem.count("rk4", "batch"), 1))

    @jax.jit
    @partial(jax.vmap, in_axes=(0, None, None))
    def fly(x: jax.Array, u: jax.Array, p: jax.Array) -> jax.Array:
        terms = diffrax.ODETerm(lambda _t, x, _: rate(x, u, p))
        return _solve(terms, _RungeKutta(), x, problem.dt("rk4"), steps)

    return Job(lambda _: jax.block_until_ready(fly(starts, u, p)), lambda ends: np.asarray(ends)[0])


def monte_carlo(problem: Problem) -> Job:
    """Flights of SDCOM side by side, in blocks that stay in the cache; 32-bit noise, 64-bit state."""
    step = row_by_row(problem, "sdcom_euler_maruyama")
    start, u, p, h = (jnp.asarray(it) for it in problem.flight("monte_carlo"))
    members, steps = (problem.count("monte_carlo", key) for key in ("members", "steps"))
    channels, root = problem.count("monte_carlo", "channels"), jnp.sqrt(h[0])
    batched = jax.vmap(step, in_axes=(1, None, None, None, 1), out_axes=1)

    @jax.jit
    def fly(key: jax.Array, u: jax.Array, p: jax.Array) -> jax.Array:
        def one(x: jax.Array, key: jax.Array) -> tuple[jax.Array, None]:
            noise = jax.random.normal(key, (channels, BLOCK), dtype=jnp.float32)
            return batched(x, u, p, h, root * noise.astype(jnp.float64)), None

        def block(key: jax.Array) -> jax.Array:
            starts = jnp.tile(start[:, None], (1, BLOCK))
            end: jax.Array = lax.scan(one, starts, jax.random.split(key, steps))[0]
            return end

        ends: jax.Array = lax.map(block, jax.random.split(key, members // BLOCK))
        return ends

    def values(ends: jax.Array) -> Array:
        return moments(np.concatenate(np.asarray(ends), axis=1).T)

    return Job(lambda seed: jax.block_until_ready(fly(jax.random.key(seed), u, p)), values)


def diffrax_monte_carlo(problem: Problem) -> Job:
    """Flights of SDCOM side by side, by diffrax; all in 64 bits."""
    function = compiled(problem.function("sdcom_drift_diffusion"), jnp, stores=False)
    start, u, p, _ = (jnp.asarray(it) for it in problem.flight("monte_carlo"))
    members, steps = (problem.count("monte_carlo", key) for key in ("members", "steps"))
    channels = problem.count("monte_carlo", "channels")

    def part(index: int, x: jax.Array) -> jax.Array:
        values = function(x, u, p)[index]
        return jnp.stack([jnp.asarray(value, dtype=jnp.float64) for value in values])

    @jax.jit
    @jax.vmap
    def fly(key: jax.Array) -> jax.Array:
        noise = diffrax.UnsafeBrownianPath((channels,), key)
        terms = diffrax.MultiTerm(
            diffrax.ODETerm(lambda _t, x, _: part(0, x)),
            diffrax.ControlTerm(lambda _t, x, _: part(1, x).reshape(-1, channels), noise),
        )
        return _solve(terms, diffrax.Euler(), start, problem.dt("monte_carlo"), steps)

    def run(seed: int) -> jax.Array:
        return jax.block_until_ready(fly(jax.random.split(jax.random.key(seed), members)))

    return Job(run, lambda ends: moments(np.asarray(ends)))


def modes(problem: Problem) -> Job:
    """Ensembles of the three modes; 32-bit noise, 64-bit state."""
    stiffness, damping, sigma, decay, intensity = jnp.asarray(problem.array("modes", "rates").T[:, :, np.newaxis])
    h = problem.dt("modes")
    runs, steps = problem.count("modes", "runs"), problem.count("modes", "steps")
    shape, root = (len(sigma), runs), np.sqrt(h)

    @jax.jit
    def simulate(key: jax.Array) -> jax.Array:
        def one(state: State, key: jax.Array) -> tuple[State, jax.Array]:
            eta, eta_dot, chi = state
            dw = root * jax.random.normal(key, shape, dtype=jnp.float32).astype(jnp.float64)
            acceleration = -stiffness * eta - damping * eta_dot
            eta, eta_dot = eta + h * eta_dot, eta_dot + h * acceleration + sigma * dw
            chi = chi - h * decay * chi + intensity * dw
            sums = jnp.stack([it.sum(axis=1) for it in (eta, eta * eta, chi, chi * chi)])
            return (eta, eta_dot, chi), sums

        rest = jnp.zeros(shape)
        return lax.scan(one, (rest, rest, rest), jax.random.split(key, steps))[1]

    def values(sums: jax.Array) -> Array:
        return moments_of_sums(np.asarray(sums).transpose(2, 0, 1), runs)

    return Job(lambda seed: jax.block_until_ready(simulate(jax.random.key(seed))), values)


def jobs(problem: Problem) -> dict[str, Callable[[], Job]]:
    """All jobs, by name."""
    return {
        "dcom_drift": lambda: drift(problem),
        "dcom_drift_jacobians": lambda: drift_jacobians(problem),
        "sdcom_drift_diffusion": lambda: drift_diffusion(problem),
        "rk4": lambda: runge_kutta(problem),
        "rk4_diffrax": lambda: diffrax_runge_kutta(problem),
        "monte_carlo": lambda: monte_carlo(problem),
        "monte_carlo_diffrax": lambda: diffrax_monte_carlo(problem),
        "modes": lambda: modes(problem),
    }


if __name__ == "__main__":
    serve(jobs)
