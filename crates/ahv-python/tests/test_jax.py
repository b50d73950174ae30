"""Models as pure functions of JAX, on the CPU."""

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import ahv
from test_functions import points

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_platforms", "cpu")


@pytest.mark.parametrize("name", ["com", "dcom", "sdcom", "flexible_mode"])
@pytest.mark.parametrize("kind", ["drift", "diffusion", "outputs"])
def test_results_to_rounding(name, kind):
    model = ahv.model(name)
    if kind == "diffusion" and not model.increments.names:
        with pytest.raises(ahv.RequestError, match="unknown result `diffusion`"):
            model.jax(kind)
        return
    x, u = points(model, 50, seed=4)
    found = jax.jit(jax.vmap(model.jax(kind)))(x, u)
    compiled = model.output(x, u) if kind == "outputs" else getattr(model, kind)(x, u)
    scale = np.abs(compiled).max(axis=0)
    assert (np.abs(found - compiled) <= 1e-11 * scale).all()


def test_derivatives_of_jax_are_the_generated_ones():
    model = ahv.dcom
    drift = model.jax()
    (x,), (u,) = points(model, 1, seed=5)
    by_state, by_input = model.jacobians(x, u)
    np.testing.assert_allclose(jax.jacfwd(drift)(x, u), by_state, rtol=1e-9, atol=1e-9 * np.abs(by_state).max())
    np.testing.assert_allclose(jax.jacrev(drift, 1)(x, u), by_input, rtol=1e-9, atol=1e-9 * np.abs(by_input).max())
    p = model.parameters.values
    slope = jax.grad(lambda p: drift(x, u, p)[0])(p)
    np.testing.assert_allclose(slope, model.parameter_jacobian(x, u)[0], rtol=1e-9, atol=1e-12)


def test_single_precision_stays_so():
    model = ahv.com_rigid
    trim = model.trim()
    x, u = (jnp.asarray(it.values, jnp.float32) for it in (trim.state, trim.input))
    assert model.jax()(x, u).dtype == jnp.float32


def test_diffrax_flies_a_member():
    """The drift of SDCOM without noise, by Tsitouras' method: to its tolerance the compiled one."""
    model = ahv.sdcom
    trim = model.trim()
    start = trim.state.replace(alpha=trim.state.alpha + 0.001).values
    drift, u = model.jax(), trim.input.values
    flight = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda _t, x, _args: drift(x, u)),
        diffrax.Tsit5(),
        0.0,
        0.5,
        0.001,
        jnp.asarray(start),
        stepsize_controller=diffrax.PIDController(rtol=1e-10, atol=1e-10),
    )
    from scipy.integrate import solve_ivp

    compiled = solve_ivp(lambda _, x: model.drift(x, u), (0.0, 0.5), start, method="DOP853", rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(flight.ys[-1], compiled.y[:, -1], rtol=1e-7, atol=1e-8)


def test_diffrax_flies_sdcom_with_noise():
    """Mean and spread of members that diffrax flies are those of the compiled engine, within four standard errors."""
    model = ahv.sdcom
    trim = model.trim()
    drift, diffusion, u = model.jax("drift"), model.jax("diffusion"), trim.input.values
    members, t_end, dt = 1000, 0.1, 0.002

    @jax.jit
    @jax.vmap
    def fly(key):
        path = diffrax.VirtualBrownianTree(0.0, t_end, tol=dt / 4, shape=(6,), key=key)
        noise = diffrax.ControlTerm(lambda _t, x, _args: diffusion(x, u), path)
        terms = diffrax.MultiTerm(diffrax.ODETerm(lambda _t, x, _args: drift(x, u)), noise)
        start = jnp.asarray(trim.state.values)
        return diffrax.diffeqsolve(terms, diffrax.Euler(), 0.0, t_end, dt, start, max_steps=200).ys[-1]

    theirs = np.asarray(fly(jax.random.split(jax.random.key(1), members)))
    own = model.montecarlo(members=20_000, t_end=t_end, dt=dt, scheme="euler-maruyama", seed=1, snapshots=1)
    error = own.std[-1] * np.sqrt(1 / members + 1 / own.members)
    assert (np.abs(theirs.mean(axis=0) - own.mean[-1]) < 4 * error).all()
    assert (np.abs(theirs.std(axis=0, ddof=1) / own.std[-1] - 1) < 4 * np.sqrt(0.5 / members)).all()
