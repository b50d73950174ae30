"""DCOM, (1)-(4), and SDCOM, (24)-(35): thrust is a coefficient, the table says how many flexible modes there are."""

from __future__ import annotations

from ahv_generator.modelling import NOT_ZERO, Family, Model, Outline, Quantity, Rule, Variable, sqrt
from ahv_generator.models.dcom import (
    CANARD,
    DELTA_C,
    FITS,
    INPUT,
    control_variables,
    define_flight_environment,
    define_forces,
    define_generalized_forces,
)
from ahv_generator.models.feedback import StrictFeedback
from ahv_generator.models.flexible import (
    CHI,
    ETA,
    ETA_DOT,
    coordinates,
    define_modal_acceleration,
    index,
    modal_load,
    modal_parameters,
    modal_state,
    modes_of,
    structural_modes,
)
from ahv_generator.models.flight import (
    ALPHA,
    DELTA_E,
    EARTH,
    ENVIRONMENT,
    PHI,
    RIGID_STATE,
    VEHICLE,
    steady_flight,
)
from ahv_generator.models.lie_derivatives import add_lie_derivatives
from ahv_generator.models.noise import (
    NOISE,
    PERTURBATIONS,
    RIGID_INCREMENTS,
    modal_gains,
    modal_increments,
    noise_parameters,
    perturbation_gains,
)
from ahv_generator.models.printed import add_printed_parts, define_printed_rates, printed_gains
from ahv_generator.models.reduction import REDUCTION
from ahv_generator.models.sdcom import (
    ALPHA_GUST,
    FLEXIBLE_OUTLOOKS,
    GUST,
    coloured_gains,
    coloured_modes,
    coloured_states,
    define_exact_rates,
    numbered_modes,
)
from ahv_generator.models.vehicle import FORCES, add_outlooks, define_rigid_rates

GUST_INCREMENT = Variable("w_gust", "w_g", "s^0.5", "Wiener increment that drives the gust")


def family(table: Outline) -> Family:
    """The family of a table with as many flexible modes as it has sections `[C_N_1]`, `[C_N_2]`, ..."""
    modes = table.numbered("C_N_")
    made = Family()
    _declare(made, modes)
    increments = RIGID_INCREMENTS + modal_increments(modes)
    reduced = RIGID_STATE + coloured_states(modes)
    by_mode = numbered_modes(modes)
    title = "decoupled control-oriented model"
    made.model("dcom", title, "(1)-(4)", states=RIGID_STATE + modal_state(modes), inputs=INPUT, noise=increments)(dcom)
    stochastic = f"stochastic {title}"
    made.model(
        "sdcom",
        f"{stochastic}, exact form",
        "(24)-(35)",
        states=reduced,
        inputs=INPUT,
        noise=increments,
        modes=by_mode,
    )(sdcom)
    made.model(
        "sdcom_printed",
        f"{stochastic} as printed, without its misprints",
        "(24)-(35)",
        states=reduced,
        inputs=INPUT,
        noise=increments,
        modes=by_mode,
        audited=True,
    )(sdcom_printed)
    made.model(
        "sdcom_gust",
        f"{stochastic} with a band-limited gust",
        "(24)-(27)",
        states=(*reduced, ALPHA_GUST),
        inputs=INPUT,
        noise=(RIGID_INCREMENTS[2], *modal_increments(modes), GUST_INCREMENT),
        modes=by_mode,
    )(sdcom_gust)
    return made


def _declare(made: Family, modes: range) -> None:
    """Parameters, choices, curve fits and bounds."""
    made.parameters("vehicle", *VEHICLE)
    made.parameters("environment", *ENVIRONMENT)
    made.parameters("modes", *modal_parameters(modes))
    made.parameters("noise", *noise_parameters(modes))
    with made.only_for("sdcom_gust"):
        made.parameters("noise", *GUST)
    made.choices(CANARD, EARTH, NOISE, REDUCTION)
    eta, control = coordinates(modes), (ALPHA, DELTA_E, DELTA_C)

    def fit(letter: str, doc: str, variables: tuple[Variable, ...], required: tuple[str, ...] = ()) -> Quantity:
        key, affine = f"C_{letter}", "the flexible coordinates, as (27) needs it"
        names = tuple(v.name for v in eta)
        return Quantity(key, key, "1", doc, (*variables, *eta), required, "law (4) needs it", names, affine)

    made.quantities(
        fit("T", "thrust coefficient", (PHI, ALPHA)),
        fit("L", "lift coefficient", control, required=("delta_e", "delta_c")),
        fit("D", "drag coefficient", control),
        fit("M", "pitching-moment coefficient", control),
    )
    for i in modes:
        doc = f"generalized-force coefficient of mode {i}"
        made.quantities(Quantity(f"C_N_{i}", rf"C_{{N_{index(i)}}}", "(ft/slug)^0.5", doc, control))
    made.rules(Rule("not-zero", ((1.0, ("c_l_delta_c",)),), NOT_ZERO, "law (4) divides by the C_L of `delta_c`"))
    made.bounds(*RIGID_STATE, ETA, ETA_DOT, CHI)
    with made.only_for("sdcom_gust"):
        made.bounds(ALPHA_GUST)
    made.bounds(*INPUT)


def dcom(model: Model) -> None:
    """The decoupled control-oriented model, with the noise that drives its reduction."""
    modes = modes_of(model.table)
    define_flight_environment(model)
    variables = control_variables(model)
    turn = define_forces(model, variables)
    forces = define_generalized_forces(model, variables)
    rates = define_rigid_rates(model, turn)
    for i, force in zip(modes, forces, strict=True):
        rates[f"eta_{i}"] = model[f"eta_dot_{i}"]
        rates[f"eta_dot_{i}"] = define_modal_acceleration(model, i, modal_load(model, i, force))
    model.motion(rates, "(1)")
    add_outlooks(model, "c_n", "generalized_force", fits=FITS, forces=FORCES)
    gains = perturbation_gains(model, rates)
    gains |= modal_gains(model, {f"eta_dot_{i}": model[f"sigma_{i}"] for i in modes})
    model.diffusion(gains, PERTURBATIONS + "; the modes are driven as in (17)", "(17)")
    add_lie_derivatives(model, "(1)")
    steady_flight(model, structural_modes(modes))


def sdcom(model: Model) -> None:
    """The exact form: everything that (1)-(4) and (25) imply."""
    modes = modes_of(model.table)
    define_flight_environment(model)
    rates, variables = define_exact_rates(model)
    model.motion(rates, "(27)")
    add_outlooks(model, *FLEXIBLE_OUTLOOKS, fits=FITS, forces=FORCES)
    model.diffusion(perturbation_gains(model, rates) | coloured_gains(model), PERTURBATIONS, "(27)")
    static = {f"eta_{i}": model[f"eta_static_{i}"] for i in modes}
    StrictFeedback(model, variables, static, rates).add()
    add_lie_derivatives(model, "(27)")
    steady_flight(model, coloured_modes(modes))


def sdcom_printed(model: Model) -> None:
    """The truncated form of the paper, and what it leaves out of the exact one."""
    define_flight_environment(model)
    form = define_printed_rates(model)
    model.motion(form.rates, "(27)")
    add_outlooks(model, *FLEXIBLE_OUTLOOKS)
    doc = "the column of w_alpha is H of (28)-(34), w_gamma drives the altitude alone"
    model.diffusion(printed_gains(model, form), doc, "(27)")
    add_printed_parts(model, form)
    add_lie_derivatives(model, "(27)")
    steady_flight(model, coloured_modes(modes_of(model.table)))
    note = "sdcom_printed leaves out Delta f, which can exceed the exact rate itself; exact is --model sdcom"
    model.note(note)


def sdcom_gust(model: Model) -> None:
    """SDCOM whose incidence is disturbed by a band-limited gust in the place of white noise."""
    define_flight_environment(model)
    with model.section("Gust", "(3)"):
        doc = "angle of attack against the air, which moves with the gust"
        incidence = model.define("incidence", model["alpha"] + model["alpha_gust"], r"\alpha_a", "rad", doc)
    rates, _ = define_exact_rates(model, incidence)
    rates["alpha_gust"] = -model["alpha_gust"] / model["gust_time"]
    model.motion(rates, "(27)")
    add_outlooks(model, *FLEXIBLE_OUTLOOKS, fits=FITS, forces=FORCES)
    gains = coloured_gains(model)
    gains["alpha", "w_q"] = model["w_q"]
    gains["alpha_gust", "w_gust"] = model["gust_rms"] * sqrt(2 / model["gust_time"])
    model.diffusion(gains, "the gust is an Ornstein-Uhlenbeck process of rms gust_rms", "(27)")
    add_lie_derivatives(model, "(27)")
    steady_flight(model, coloured_modes(modes_of(model.table)) | {"gust": ("alpha_gust",)})
