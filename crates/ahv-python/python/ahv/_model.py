"""A model: its functions of whole arrays, and the analyses."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._command import Option, warn, words
from ._errors import RequestError
from ._linear import LinearSystem, Pole, Regulator, Zeros
from ._module import Module
from ._names import Array, Names, Point, Vector, components, unknown
from ._results import Covariance, Dispersion, MonteCarlo, Rare, Trajectory, Trim

Numbers = npt.ArrayLike | Mapping[str, float] | Vector


class Model:
    """A model in its condition: dx/dt = f(x, u; p), dx = f dt + G dW, with names and units.

    Made by `ahv.model`, or as an attribute of the package: ``ahv.sdcom``. It does not change; `replace` makes another.

    Attributes
    ----------
    states, inputs, outputs, increments, parameter_names : Names
        Names and units of x, u, the quantities that people look at, W and p.
    parameters : Vector
        Values of p.
    uncertainty : Vector
        Their relative uncertainties.
    state_bounds, input_bounds : dict of name to (low, high)
        Where the model is meant to be used.
    """

    def __init__(self, module: Module, name: str, options: Mapping[str, Option]) -> None:
        self.module = module
        self._options = dict(options)
        self.vehicle = module.native.Vehicle(words({"model": name, **options}))
        warn(self.vehicle.notes)
        self.name = name

    def replace(self, **options: Option) -> Model:
        """The same model with another ``table``, ``set``, ``units`` or choice."""
        return Model(self.module, self.name, {**self._options, **options})

    @property
    def title(self) -> str:
        """What it is, in a few words."""
        return self.vehicle.title

    @property
    def unit_system(self) -> str:
        """The system of units in which it is run."""
        return self.vehicle.unit_system

    @property
    def set(self) -> str:
        """Its set of parameters."""
        return self.vehicle.set

    @property
    def sets(self) -> tuple[str, ...]:
        """The sets of parameters of its table."""
        return tuple(self.vehicle.sets)

    @property
    def choices(self) -> dict[str, str | None]:
        """What is chosen; None for a mixture that has no name."""
        return {name: chosen for name, chosen, _ in self.vehicle.choices}

    @property
    def options(self) -> dict[str, tuple[str, ...]]:
        """What there is to choose."""
        return {name: tuple(options) for name, _, options in self.vehicle.choices}

    @property
    def given(self) -> tuple[str, ...]:
        """What is given of a steady state."""
        return tuple(self.vehicle.given)

    @cached_property
    def states(self) -> Names:
        """Names and units of x."""
        return _names(self.vehicle.states)

    @cached_property
    def inputs(self) -> Names:
        """Names and units of u."""
        return _names(self.vehicle.inputs)

    @cached_property
    def outputs(self) -> Names:
        """Names and units of the quantities that people look at."""
        return _names(self.vehicle.outputs)

    @cached_property
    def increments(self) -> Names:
        """Names and units of the Wiener processes."""
        return _names(self.vehicle.increments)

    @cached_property
    def parameter_names(self) -> Names:
        """Names and units of p."""
        return _names(self.vehicle.parameters)

    @cached_property
    def parameters(self) -> Vector:
        """Values of p."""
        return self.parameter_names.vector(self.vehicle.parameter_values)

    @cached_property
    def uncertainty(self) -> Vector:
        """Relative uncertainties of p."""
        basis = Names(self.parameter_names.names, ("1",) * len(self.parameter_names))
        return basis.vector(self.vehicle.uncertainty)

    @property
    def state_bounds(self) -> dict[str, tuple[float, float]]:
        """The validity box of x."""
        return dict(zip(self.states.names, self.vehicle.state_bounds, strict=True))

    @property
    def input_bounds(self) -> dict[str, tuple[float, float]]:
        """The validity box of u."""
        return dict(zip(self.inputs.names, self.vehicle.input_bounds, strict=True))

    # Functions of whole arrays.

    def drift(self, x: Numbers, u: Numbers, p: Numbers | None = None, *, out: Array | None = None) -> Array:
        """The drift f(x, u; p).

        Parameters
        ----------
        x : (..., n)
            States.
        u : (..., m)
            Inputs.
        p : (..., k), optional
            Parameters; the model's own where none are given.
        out : (..., n), optional
            Where to write the result.

        Returns
        -------
        (..., n)
            dx/dt, each in the unit of its state per second. Leading dimensions are those of x, u and p, broadcast.
        """
        return self._evaluate("drift", (len(self.states),), (x, u, p), out)

    def jacobians(self, x: Numbers, u: Numbers, p: Numbers | None = None) -> tuple[Array, Array]:
        """∂f/∂x of shape (..., n, n) and ∂f/∂u of shape (..., n, m), by the generated derivatives."""
        n = len(self.states)
        both = self._evaluate("jacobians", (n, n + len(self.inputs)), (x, u, p))
        return both[..., :n], both[..., n:]

    def parameter_jacobian(self, x: Numbers, u: Numbers, p: Numbers | None = None) -> Array:
        """∂f/∂p of shape (..., n, k)."""
        return self._evaluate("parameter_jacobian", (len(self.states), len(self.parameter_names)), (x, u, p))

    def diffusion(self, x: Numbers, u: Numbers, p: Numbers | None = None) -> Array:
        """G(x, u; p) of shape (..., n, w), with a column for each Wiener process."""
        return self._evaluate("diffusion", (len(self.states), len(self.increments)), (x, u, p))

    def output(self, x: Numbers, u: Numbers, p: Numbers | None = None) -> Array:
        """The quantities that people look at, of shape (..., q)."""
        return self._evaluate("outputs", (len(self.outputs),), (x, u, p))

    def _evaluate(
        self,
        kind: str,
        shape: tuple[int, ...],
        arguments: tuple[Numbers, Numbers, Numbers | None],
        out: Array | None = None,
    ) -> Array:
        x, u, p = arguments
        given = (
            components("x", x, self.states),
            components("u", u, self.inputs),
            self.parameters.values if p is None else components("p", p, self.parameter_names),
        )
        if p is not None and not np.isfinite(given[2]).all():
            raise RequestError("p: it holds a number that is not finite")
        try:
            leading = np.broadcast_shapes(*(it.shape[:-1] for it in given))
        except ValueError:
            shapes = ", ".join(f"{name}: {it.shape}" for name, it in zip("xup", given, strict=True))
            raise RequestError(f"leading dimensions do not fit: {shapes}") from None
        if out is None:
            out = np.empty(leading + shape)
        elif out.shape != leading + shape or out.dtype != np.float64 or not out.flags.c_contiguous:
            raise RequestError(f"out: it must be a contiguous array of float64 of the shape {leading + shape}")
        if out.size == 0:
            return out
        flat = out.reshape(-1, int(np.prod(shape)))
        x, u, p = (_flat(it, leading) for it in given)
        self.vehicle.evaluate(kind, x, u, p, flat)
        return out

    # Analyses.

    def point(self, x: Numbers, u: Numbers) -> Point:
        """A state and an input with the quantities that people look at."""
        state, held = components("x", x, self.states), components("u", u, self.inputs)
        if state.ndim != 1 or held.ndim != 1:
            raise RequestError("x, u: there must be one of each")
        outputs = self.output(state, held)
        return Point(self.states.vector(state), self.inputs.vector(held), self.outputs.vector(outputs))

    def trim(self, *, input: Mapping[str, float] | None = None, **given: float) -> Trim:
        """The steady state of a condition.

        Parameters
        ----------
        input
            Inputs that are held, where they are not 0.
        **given
            What is given of the steady state, by the names in ``model.given``; the model's own where it is not.

        Raises
        ------
        NumericError
            There is none inside the validity box of the inputs; the message has the bound that blocks.
        """
        return Trim.of(self, self._run("trim", {"input": input, **given}))

    def linearize(
        self,
        at: Point | Trim | None = None,
        u: Numbers | None = None,
        *,
        inputs: Sequence[str] = (),
        outputs: Sequence[str] = (),
    ) -> LinearSystem:
        """The linear system about a point: dx/dt = A x + B u, y = C x + D u, for deviations.

        Parameters
        ----------
        at
            A trim or point, or a state, with ``u``; the trim of the model's own condition where there is none.
        inputs, outputs
            Names; those of the model's path where there are none. Outputs may be states and other quantities.
        """
        if at is None:
            at = self.trim()
        if u is not None:
            at = self.point(at, u)  # type: ignore[arg-type]
        point = at.point if isinstance(at, Trim) else at
        if not isinstance(point, Point):
            raise RequestError("u: a state needs an input beside it")
        x, held = components("x", point.state, self.states), components("u", point.input, self.inputs)
        matrices, own, seen = self.vehicle.linearize(x, held, list(inputs), list(outputs))
        units = {**self._units(), **dict(zip(self.outputs.names, self.outputs.units, strict=True))}
        shapes = [(len(x), len(x)), (len(x), len(own)), (len(seen), len(x)), (len(seen), len(own))]
        a, b, c, d = (np.array(it).reshape(shape) for it, shape in zip(matrices, shapes, strict=True))
        return LinearSystem(
            A=a,
            B=b,
            C=c,
            D=d,
            states=self.states,
            inputs=Names(tuple(own), tuple(units[name] for name in own)),
            outputs=Names(tuple(seen), tuple(units[name] for name in seen)),
            point=point,
            model=self,
        )

    def poles(self, at: Point | Trim | None = None) -> list[Pole]:
        """Poles about a point, by rising frequency, with their modes."""
        return self.linearize(at).poles()

    def zeros(
        self, at: Point | Trim | None = None, *, inputs: Sequence[str] = (), outputs: Sequence[str] = ()
    ) -> Zeros:
        """Zeros about a point, from inputs to outputs."""
        return self.linearize(at, inputs=inputs, outputs=outputs).zeros()

    def lqr(
        self,
        *,
        state_deviation: Mapping[str, float] | None = None,
        input_deviation: Mapping[str, float] | None = None,
        out: str | Path | None = None,
        input: Mapping[str, float] | None = None,
        **given: float,
    ) -> Regulator:
        """The regulator about a trim, for deviations that cost 1; ``out`` keeps it in a file of gains."""
        options = {"state_deviation": state_deviation, "input_deviation": input_deviation, "out": out, "input": input}
        return Regulator.of(self, self._run("lqr", {**options, **given}))

    def simulate(
        self,
        t_end: float,
        dt: float,
        *,
        scheme: str | None = None,
        stochastic: bool = False,
        seed: int = 0,
        initial: Mapping[str, float] | None = None,
        input: Mapping[str, float] | None = None,
        **given: float,
    ) -> Trajectory:
        """A flight from a trim with held inputs, with the steps of ``scheme``.

        Parameters
        ----------
        t_end, dt
            End and step in s.
        scheme
            ``"rk4"``, ``"dormand-prince54"``, … or with noise ``"splitting"``, ``"euler-maruyama"``, …
        stochastic
            Drive a model without coloured noise with its noise too.
        initial
            Components of the state at the start that are not those of the trim.
        """
        with tempfile.TemporaryDirectory(prefix="ahv-") as folder:
            file = Path(folder) / "flight.csv"
            options = {
                "t_end": t_end,
                "dt": dt,
                "scheme": scheme,
                "stochastic": stochastic,
                "seed": seed,
                "initial": initial,
                "input": input,
                "out": file,
            }
            told = self._run("simulate", {**options, **given})
            rows = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
        return Trajectory(
            rows[:, 0].copy(), rows[:, 1:].copy(), self.states, self.inputs.vector(_of(told["input"], self.inputs))
        )

    def montecarlo(self, *, members: int, t_end: float, **options: Option) -> MonteCarlo:
        """Many flights with noise and dispersions: the command ``ahv montecarlo``, by the names of its flags.

        Parameters
        ----------
        members
            Flights.
        t_end
            End of the flights in s.
        **options
            ``dt``, ``seed``, ``threads``, ``scheme``, ``mode``, ``disperse``, ``state_std``, ``input_std``, ``limit``,
            ``snapshots``, ``feedback``, ``out``, …, and what is given of the trim that they start from. The same seed
            gives the same bits whatever the threads.

        Raises
        ------
        KeyboardInterrupt
            After Ctrl-C, in order.
        """
        return MonteCarlo.of(self, self._run("montecarlo", {"members": members, "t_end": t_end, **options}))

    def rare(self, *, passes: Mapping[str, float], t_end: float, **options: Option) -> Rare:
        """Probability that a state passes a limit before ``t_end``, by splitting: the command ``ahv rare``."""
        return Rare.of(self, self._run("rare", {"passes": passes, "t_end": t_end, **options}))

    def disperse(self, *, members: int = 1000, **options: Option) -> Dispersion:
        """Trims and roots of vehicles whose parameters are drawn: the command ``ahv disperse``."""
        return Dispersion.of(self, self._run("disperse", {"members": members, **options}))

    def covariance(self, *, t_end: float = 1.0, **options: Option) -> Covariance:
        """Covariance of the deviations from a flight, linear and sampled: the command ``ahv covariance``."""
        return Covariance.of(self, self._run("covariance", {"t_end": t_end, **options}))

    # Other programs.

    def casadi(self, kind: str | None = None, *, parameters: bool = False) -> Any:
        """A CasADi ``Function`` of (x, u), with names, from the IR.

        Its results are ``drift``, ``state_jacobian``, ``input_jacobian``, ``outputs``, and of a model with noise
        ``diffusion``; only that of ``kind`` where one is named (also ``parameter_jacobian``). With ``parameters`` it is
        one of (x, u, p), else p is the model's own.
        """
        from ._ir import casadi_function

        return casadi_function(self, kind, parameters)

    def jax(self, kind: str = "drift") -> Any:
        """A pure function (x, u, p) → result for ``jax.jit``, ``vmap`` and ``grad``, from the IR; p may be left out.

        x, u and p are vectors; ``jax.vmap`` makes it one of many. ``kind`` is as for `casadi`.
        """
        from ._ir import jax_function

        return jax_function(self, kind)

    def _units(self) -> dict[str, str]:
        both = (self.states, self.inputs)
        return {name: unit for basis in both for name, unit in zip(basis.names, basis.units, strict=True)}

    def flags(self, options: Mapping[str, Option]) -> dict[str, Option]:
        """Options of a command over this model as its flags; numbers of its vectors get their units."""
        units = {**self._units(), **dict(zip(self.outputs.names, self.outputs.units, strict=True))}
        flags: dict[str, Option] = {}
        for name, value in options.items():
            if name in self.given and not isinstance(value, str) and value is not None:
                flags[name] = f"{_real(name, value)!r}rad" if units.get(name) == "rad" else _real(name, value)
            elif isinstance(value, Mapping):
                flags[name] = {key: _with_unit(name, key, it, units) for key, it in value.items()}
            else:
                flags[name] = value
        return {"model": self.name, **self._options, **flags}

    def _run(self, command: str, options: Mapping[str, Option]) -> dict[str, Any]:
        """What a command over this model says."""
        return self.module.command(command, **self.flags(options))

    def __repr__(self) -> str:
        chosen = "".join(f", {name} {value or 'of the table'}" for name, value in self.choices.items())
        return (
            f"{self.name}: {self.title} (set {self.set}{chosen}, {self.unit_system})\n"
            f"states: {self.states!r}\ninputs: {self.inputs!r}"
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{kind}</th><td>{basis!r}</td></tr>"
            for kind, basis in (("states", self.states), ("inputs", self.inputs), ("outputs", self.outputs))
        )
        return f"<b>{self.name}</b>: {self.title}<table>{rows}</table>"


def _names(named: tuple[list[str], list[str]]) -> Names:
    return Names(tuple(named[0]), tuple(named[1]))


def _of(values: Mapping[str, float], basis: Names) -> Array:
    return np.array([values[name] for name in basis.names])


def _real(name: str, value: object) -> float:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise RequestError(f"{name}: {value!r} is not a number") from None


def _with_unit(option: str, name: str, value: object, units: Mapping[str, str]) -> str:
    if isinstance(value, str):
        return value
    if name not in units:
        raise RequestError(f"{option}: {unknown('name', name, tuple(units))}")
    unit = "" if units[name] == "1" else units[name]
    if isinstance(value, tuple):
        low, high = (f"{_real(name, end)!r}{unit}" for end in value)
        return f"{low}..{high}"
    return f"{_real(name, value)!r}{unit}"


def _flat(array: Array, leading: tuple[int, ...]) -> Array:
    """Rows of an array, one for each point; one for all is not copied."""
    if all(length == 1 for length in array.shape[:-1]):
        return array.reshape(1, array.shape[-1])
    if array.shape[:-1] != leading:
        array = np.ascontiguousarray(np.broadcast_to(array, (*leading, array.shape[-1])))
    return array.reshape(-1, array.shape[-1])
