"""Reference answers of the examples' programs: what trim, linearize, poles and simulate must print with ``--json``.

The file is JSON: for each question the program, its arguments, and the expected values by JSON pointer. A published
vehicle is that of `vehicles`; one of the built-in family is what SymPy derives from its table, for nobody published its
coefficients.
"""

import json
import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy
import scipy.linalg
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from . import six_dof
from .roots import Case
from .vehicles import PUBLISHED, Vector, Vehicle

TABLES = {"own-vehicle": ("two-mode", "two_mode"), "four-mode": ("four-mode", "four_mode")}
"""Folder and name of the table of each program whose vehicle is of the family `dcom`."""

WINGED_CONES = {"winged-cone": "winged_cone", "wang-stengel": "wang_stengel"}
"""The model of each program."""

CONDITION = "--velocity 15060 --altitude 110000"
"""Where they fly, as arguments; `Vehicle.given` has it as well."""

PRINTED = {
    "velocity": 7702.0808,
    "altitude": 85000.0,
    "alpha": math.radians(1.5153),
    "phi": 0.2514,
    "delta_e": math.radians(11.4635),
}
"""Where a public study prints the linear system of the rigid vehicle: not its trim."""

CANARD = math.radians(2.0)
"""Deflection of the canard in the flight, where its square counts."""

END, STEP = 1.0, 0.001
"""Duration and step of a flight in s."""

OFF_TRIM = {"alpha": 0.002, "pitch_rate": 0.01}
"""What a flight of a winged cone adds to the trim, in rad and rad/s."""

Answers = dict[str, object]


def answer_lines(examples: Path) -> Iterator[str]:
    """Yield the lines of the file; `examples` is the folder of the examples."""
    questions = [json.dumps(question) for question in _questions(examples)]
    yield "["
    yield from (f"{question}," for question in questions[:-1])
    yield questions[-1]
    yield "]"


def _questions(examples: Path) -> Iterator[dict[str, object]]:
    def question(program: str, arguments: str, answers: Answers) -> dict[str, object]:
        return {"program": program, "arguments": arguments, "answers": answers}

    for program, model in WINGED_CONES.items():
        vehicle = PUBLISHED[model]
        for command, answers in _about_trim(vehicle):
            yield question(program, f"{command} --model {model} {CONDITION}", answers)
        arguments, answers = _flight(vehicle)
        yield question(program, f"simulate --model {model} {CONDITION} {arguments}", answers)
    lifting = PUBLISHED["wang_stengel, elevator lifts"]
    for command, answers in _about_trim(lifting):
        arguments = f"{command} --model wang_stengel --elevator_lift fitted {CONDITION}"
        yield question("wang-stengel", arguments, answers)
    for command, answers in _about_trim(PUBLISHED["parker_canard"]):
        yield question("parker-canard", command, answers)
    yield question("parker-canard", *_at_printed_point())
    for arguments, answers in six_dof.questions(examples / "six-dof" / "six_dof.toml"):
        yield question("six-dof", arguments, answers)
    for program, (folder, table) in TABLES.items():
        case = Case(examples / folder / f"{table}.toml", "dcom", "nominal")
        for command, answers in _of_case(case):
            yield question(program, f"{command} --model dcom", answers)


def _about_trim(vehicle: Vehicle) -> Iterator[tuple[str, Answers]]:
    point = vehicle.trim()
    by_state, by_input = vehicle.system(point)
    yield "trim", _at(vehicle.states, vehicle.inputs, point)
    yield f"linearize --inputs {','.join(vehicle.inputs)}", {"/A": by_state.tolist(), "/B": by_input.tolist()}
    yield "poles", {"/poles": _parts(by_state)}


def _flight(vehicle: Vehicle) -> tuple[str, Answers]:
    """A flight off the trim with held inputs."""
    point = vehicle.trim()
    start = {name: float(point[vehicle.names.index(name)]) + size for name, size in OFF_TRIM.items()}
    initial = f"alpha={start['alpha']!r}rad,pitch_rate={start['pitch_rate']!r}rad/s"
    for name, value in start.items():
        point[vehicle.names.index(name)] = value
    count = len(vehicle.states)
    end = _flown(lambda state: vehicle.rates(numpy.concatenate([state, point[count:]])).real, point[:count])
    arguments = f"--t-end {END} --dt {STEP} --initial {initial} --out flight.csv"
    return arguments, {f"/final_state/{name}": value for name, value in zip(vehicle.states, end, strict=True)}


def _flown(rates: Callable[[Vector], Vector], start: Vector) -> list[float]:
    sizes = numpy.where(start == 0.0, 1.0, numpy.abs(start))
    flown = solve_ivp(lambda _, x: rates(x), (0.0, END), start, method="DOP853", rtol=1e-13, atol=1e-15 * sizes)
    if not flown.success:
        raise ValueError(flown.message)
    return [float(value) for value in flown.y[:, -1]]


def _at_printed_point() -> tuple[str, Answers]:
    vehicle = PUBLISHED["parker_canard"]
    at = PRINTED | {"delta_c": CANARD}
    by_state, by_input = vehicle.system(numpy.array([at.get(name, 0.0) for name in vehicle.names]))
    angles = {"alpha", "delta_e", "delta_c"}

    def assigned(names: Iterable[str]) -> str:
        return ",".join(f"{name}={at[name]!r}{'rad' if name in angles else ''}" for name in names if name in at)

    arguments = f"linearize --state {assigned(vehicle.states)} --input {assigned(vehicle.inputs)}"
    arguments += f" --inputs {','.join(vehicle.inputs)}"
    return arguments, {"/A": by_state.tolist(), "/B": by_input.tolist()}


def _of_case(case: Case) -> Iterator[tuple[str, Answers]]:
    by_state, by_input = case.system()
    yield "trim", _at(case.states, case.inputs, [*case.state, *case.input])
    yield "linearize --inputs phi,delta_e", {"/A": by_state.tolist(), "/B": by_input.tolist()}
    yield "poles", {"/poles": _parts(by_state)}


def _at(states: tuple[str, ...], inputs: tuple[str, ...], point: Iterable[float]) -> Answers:
    pointers = [f"/state/{name}" for name in states] + [f"/input/{name}" for name in inputs]
    return {pointer: float(value) for pointer, value in zip(pointers, point, strict=True)}


def _parts(matrix: NDArray[numpy.float64]) -> list[list[float]]:
    """The eigenvalues, each as real and imaginary part."""
    return [[float(root.real), float(root.imag)] for root in scipy.linalg.eigvals(matrix)]
