/* Flies DCOM with the generated C library: drift, Jacobians and 10 s of flight from the trim in level flight.
 *
 * The airframe is open-loop unstable: the elevator holds it by feedback of angle of attack, pitch rate and path angle.
 */
#include <stdio.h>
#include <stdlib.h>

#include "dcom.h"

#define STEP_S 0.01
#define STEPS 1000
#define STEPS_PER_ROW 100

static const double DEG_PER_RAD = 57.29577951308232;

/* Level flight at 7702.0808 ft/s and 85 000 ft, from `ahv trim --model dcom`. */
static const DcomState TRIM = {
    7702.0808,  /* velocity, ft/s */
    85000.0,    /* altitude, ft */
    0.0,        /* gamma, rad */
    0.0262105,  /* alpha, rad */
    0.0,        /* pitch_rate, rad/s */
    0.6275547,  /* eta_1, (ft*slug)^0.5 */
    0.0,        /* eta_dot_1 */
    -0.0136979, /* eta_2 */
    0.0,        /* eta_dot_2 */
    -0.0371914, /* eta_3 */
    0.0         /* eta_dot_3 */
};
static const DcomInput TRIM_INPUT = {
    0.2820906, /* phi */
    0.2286478, /* delta_e, rad */
    0.0        /* delta_c, rad */
};

/* The inputs of the next step: the trim's, and the elevator by feedback. */
static DcomInput controlled(const DcomState *x)
{
    DcomInput u = TRIM_INPUT;
    u.delta_e += (2.0 * (x->alpha - TRIM.alpha) + 1.0 * x->pitch_rate) + 0.5 * x->gamma;
    return u;
}

static void print_row(double t, const DcomState *x)
{
    (void)printf("%6.2f %12.6f %13.6f %11.7f %11.7f %11.7f %11.8f\n", t, x->velocity, x->altitude,
                 x->gamma * DEG_PER_RAD, x->alpha * DEG_PER_RAD, x->pitch_rate * DEG_PER_RAD, x->eta_1);
}

int main(void)
{
    DcomParameters parameters = dcom_nominal;
    DcomPrepared prepared;
    DcomState x = TRIM;
    DcomInput u = TRIM_INPUT;
    DcomState rate;
    DcomStateJacobian by_state;
    DcomInputJacobian by_input;
    int step;

    dcom_choose_canard(&parameters, DCOM_CANARD_FREE);
    dcom_prepare(&parameters, &prepared);

    dcom_drift_and_jacobians(&x, &u, &prepared, &rate, &by_state, &by_input);
    (void)printf("at the trim:\n");
    (void)printf("  dV/dt          %14.6e ft/s^2\n", rate.velocity);
    (void)printf("  dQ/dt          %14.6e rad/s^2\n", rate.pitch_rate);
    (void)printf("  dQ/dt by alpha   %12.6f 1/s^2\n", by_state.pitch_rate.alpha);
    (void)printf("  dQ/dt by delta_e %12.6f 1/s^2\n", by_input.pitch_rate.delta_e);

    x.alpha += 0.5 / DEG_PER_RAD;
    (void)printf("\n     t     velocity      altitude       gamma       alpha  pitch_rate       eta_1\n");
    (void)printf("     s         ft/s            ft         deg         deg       deg/s (ft*slug)^0.5\n");
    print_row(0.0, &x);
    for (step = 1; step <= STEPS; step++) {
        int failed;
        u = controlled(&x);
        failed = dcom_rk4_step(&prepared, &u, STEP_S, &x);
        if (failed != 0) {
            (void)fprintf(stderr, "step %d failed: %d\n", step, failed);
            return EXIT_FAILURE;
        }
        if (step % STEPS_PER_ROW == 0) {
            print_row(step * STEP_S, &x);
        }
    }
    return EXIT_SUCCESS;
}
