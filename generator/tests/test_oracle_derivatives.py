"""Everything that the oracle derives from a drift, against central differences at 50 digits."""

from __future__ import annotations

import itertools

import mpmath
import pytest
from oracle_support import NOISY, REDUCED, TABLE_OF, Values, assert_close, central, oracle_of, values

from ahv_oracle import MODELS, Number, sample
from ahv_oracle.evaluate import DIGITS

NOISE_OF = {"gamma": "w_gamma", "alpha": "w_alpha", "pitch_rate": "w_q"}
Slopes = dict[tuple[str, str], Number]


def slopes(model: str, function: str, variables: list[str], point: Values) -> Slopes:
    """Differences of all entries of a function, by entry and variable."""
    oracle = oracle_of(model, function)
    found: Slopes = {}
    for name in variables:
        by_entry = central(lambda x, name=name: values(oracle, point | {name: x}), point[name])  # type: ignore[misc]
        found |= {(entry, name): value for entry, value in by_entry.items()}
    return found


def check(found: Slopes, results: dict[str, tuple[Number, Number]], labels: dict[tuple[str, str], str]) -> None:
    """Compare differences with the entries of these labels; without an entry the difference is zero."""
    for place, label in labels.items():
        slope = found.get(place, mpmath.mpf(0))
        if label in results:
            assert_close(slope, results[label], label)
        else:
            assert abs(slope) <= mpmath.mpf("1e-25") * results[place[0]][1], label


@pytest.mark.parametrize("model", TABLE_OF)
def test_first_derivatives_of_the_drift(model: str) -> None:
    oracle = oracle_of(model)
    kinds = {"state": oracle.model.states, "input": oracle.model.inputs, "parameter": tuple(oracle.table.values)}
    columns = [f"{kind}.{name}" for kind, names in kinds.items() for name in names]
    labels = {}
    for row, column in itertools.product(oracle.model.states, columns):
        kind, _, name = column.partition(".")
        prefix = "parameter_jacobian" if kind == "parameter" else f"jacobians.{kind}"
        labels[f"drift.{row}", column] = f"{prefix}.{row}.{name}"
    with mpmath.workdps(DIGITS):
        for index in range(2):
            point: Values = dict(sample(oracle.model, 1, index))
            check(slopes(model, "drift", columns, point), oracle.evaluate(point), labels)
    assert {label for label in oracle.labels if "jacobian" in label} <= set(labels.values())


@pytest.mark.parametrize("model", TABLE_OF)
def test_second_derivatives_of_the_drift(model: str) -> None:
    oracle = oracle_of(model)
    states = oracle.model.states
    names = [f"state.{name}" for name in states]
    with mpmath.workdps(DIGITS):
        point: Values = dict(sample(oracle.model, 2, 0))
        results, found = oracle.evaluate(point), slopes(model, "jacobians", names, point)
        for row, (i, first), (j, second) in itertools.product(states, enumerate(states), enumerate(states)):
            label = f"hessian.{row}.{first}.{second}"
            slope = found.get((f"jacobians.state.{row}.{first}", f"state.{second}"), mpmath.mpf(0))
            if j > i:
                assert label not in results
            elif label in results:
                assert_close(slope, results[label], label)
            else:
                assert abs(slope) <= mpmath.mpf("1e-25") * results[f"drift.{row}"][1], label


@pytest.mark.parametrize("model", [model for model in MODELS if model != "flexible_mode"])
def test_lie_derivatives(model: str) -> None:
    oracle, small = oracle_of(model), oracle_of(model, "drift")
    with mpmath.workdps(DIGITS):
        for index in range(3):
            point: Values = {k: mpmath.mpf(x) for k, x in sample(oracle.model, 3, index).items()}
            result = oracle.evaluate(point)
            for suffix, row in (("V", "velocity"), ("gamma", "gamma"), ("h", "altitude")):
                assert result[f"L_f_{suffix}"] == result[f"drift.{row}"]
            flow = {name: result[f"drift.{name}"][0] for name in oracle.model.states}

            def moved(time: Number, point: Values = point, flow: Values = flow) -> Values:
                return values(small, point | {f"state.{k}": point[f"state.{k}"] + time * x for k, x in flow.items()})

            # steps of 1e-15 s: rates times a step must stay small beside the states
            along = central(lambda time: moved(time * mpmath.mpf("1e-6")), 0)
            assert_close(along["drift.altitude"] * mpmath.mpf("1e6"), result["L_f2_h"], "L_f2_h")
            inputs = [f"input.{name}" for name in oracle.model.inputs]
            labels = {("L_f2_h", name): f"L_g_L_f_h.{name[6:]}" for name in inputs}
            check(slopes(model, "L_f2_h", inputs, point), result, labels)
            for suffix, row in (("V", "velocity"), ("gamma", "gamma")):
                for name in oracle.model.inputs:
                    expected = result.get(f"jacobians.input.{row}.{name}")
                    assert result.get(f"L_g_{suffix}.{name}") == expected


@pytest.mark.parametrize("model", NOISY)
def test_noise_derivatives_and_ito_correction(model: str) -> None:
    oracle = oracle_of(model)
    states, noises = oracle.model.states, oracle.model.noises
    names = [f"state.{name}" for name in states]
    with mpmath.workdps(DIGITS):
        point: Values = dict(sample(oracle.model, 4, 1))
        results, found = oracle.evaluate(point), slopes(model, "diffusion", names, point)

        def along(row: str, first: str, second: str) -> Number:
            total = mpmath.mpf(0)
            for name in states:
                change = found.get((f"diffusion.{row}.{second}", f"state.{name}"), mpmath.mpf(0))
                total += results.get(f"diffusion.{name}.{first}", (mpmath.mpf(0),))[0] * change
            return total

        for row in states:
            for first, second in itertools.product(noises, noises):
                label = f"noise_derivatives.{row}.{first}.{second}"
                if label in results:
                    assert_close(along(row, first, second), results[label], label)
                else:
                    assert abs(along(row, first, second)) < mpmath.mpf("1e-25"), label
            total = sum(along(row, noise, noise) for noise in noises) / 2
            assert abs(total - results[f"ito_correction.{row}"][0]) <= mpmath.mpf("1e-20") * (abs(total) + 1), row


@pytest.mark.parametrize("model", ["dcom", "sdcom"])
def test_rigid_noise_perturbs_along_its_state(model: str) -> None:
    oracle = oracle_of(model)
    with mpmath.workdps(DIGITS):
        point = sample(oracle.model, 5, 0)
        result = values(oracle, dict(point))
        for name, noise in NOISE_OF.items():
            for row in oracle.model.states:
                expected = result.get(f"jacobians.state.{row}.{name}", 0) * mpmath.mpf(point[f"parameter.{noise}"])
                assert abs(result.get(f"diffusion.{row}.{noise}", 0) - expected) <= mpmath.mpf("1e-45") * abs(expected)
        assert result["diffusion.alpha.w_q"] == point["parameter.w_q"]


@pytest.mark.parametrize("model", ["dcom", *REDUCED])
def test_shared_noise_is_a_correlation(model: str) -> None:
    """Modes keep their intensity; xi_1 correlates with each other mode by s, the others by s^2."""
    oracle = oracle_of(model)
    row = "eta_dot" if model == "dcom" else "chi"
    for share in (0.0, 0.6, 1.0):
        with mpmath.workdps(DIGITS):
            point = sample(oracle.model, 6, 0) | {"parameter.shared_noise": share}
            result = values(oracle, dict(point))
            column = {
                i: [result.get(f"diffusion.{row}_{i}.xi_{k}", mpmath.mpf(0)) for k in (1, 2, 3)] for i in (1, 2, 3)
            }
            size = {i: mpmath.norm(column[i]) for i in column}
            if model == "dcom":
                assert all(abs(size[i] - point[f"parameter.sigma_{i}"]) < mpmath.mpf("1e-45") for i in size)
            for i, j in ((1, 2), (1, 3), (2, 3)):
                product = mpmath.fdot(column[i], column[j]) / (size[i] * size[j])
                expected = mpmath.mpf(share) if i == 1 else mpmath.mpf(share) ** 2
                assert abs(product - expected) < mpmath.mpf("1e-40")


@pytest.mark.parametrize("model", NOISY)
def test_noise_increment_is_diffusion_times_increments(model: str) -> None:
    oracle = oracle_of(model)
    with mpmath.workdps(DIGITS):
        for index in range(5):
            point = sample(oracle.model, 6, index)
            result = oracle.evaluate(point)
            for row in oracle.model.states:
                total = mpmath.mpf(0)
                for noise in oracle.model.noises:
                    entry = result.get(f"diffusion.{row}.{noise}", (0, 0))[0]
                    total += entry * mpmath.mpf(point[f"noise.{noise}"])
                assert_close(total, result[f"noise_increment.{row}"], row)
