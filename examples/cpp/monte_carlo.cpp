// A Monte Carlo of SDCOM over the generated C library, in C++17: 1000 members fly 2 s from the trim, each with its own
// noise. Prints mean and standard deviation of the angle of attack, with their standard errors.
//
// Another standard library may draw other normal numbers from the same seed: its results agree within the errors.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "sdcom.h"

namespace {

constexpr int members = 1000;
constexpr double step_s = 0.002;
constexpr int steps_per_row = 250;
constexpr int rows = 4;
constexpr std::mt19937_64::result_type seed = 1;
constexpr double deg_per_rad = 57.29577951308232;

// Level flight at 7702.0808 ft/s and 85 000 ft, from `ahv trim --model sdcom`.
constexpr SdcomState trim = {
    7702.0808,  // velocity, ft/s
    85000.0,    // altitude, ft
    0.0,        // gamma, rad
    0.0262105,  // alpha, rad
    0.0,        // pitch_rate, rad/s
    0.0,        // chi_1, (ft*slug)^0.5
    0.0,        // chi_2
    0.0,        // chi_3
};
constexpr SdcomInput input = {
    0.2820906,  // phi
    0.2286478,  // delta_e, rad
    0.0,        // delta_c, rad
};

// Mean and sum of squared deviations, one number at a time (Welford).
class Moments {
public:
    void add(double value)
    {
        count += 1;
        const double difference = value - average;
        average += difference / count;
        squares += difference * (value - average);
    }

    double mean() const { return average; }
    double deviation() const { return std::sqrt(squares / (count - 1)); }
    double error_of_mean() const { return deviation() / std::sqrt(count); }
    // Of a nearly normal quantity.
    double error_of_deviation() const { return deviation() / std::sqrt(2.0 * (count - 1)); }

private:
    int count = 0;
    double average = 0.0;
    double squares = 0.0;
};

}  // namespace

int main()
{
    DcomParameters parameters = dcom_nominal;
    dcom_choose_noise(&parameters, DCOM_NOISE_INDEPENDENT);
    SdcomPrepared prepared;
    sdcom_prepare(&parameters, &prepared);

    // A seed that stands here makes the run repeatable.
    std::mt19937_64 source(seed);  // NOLINT(bugprone-random-generator-seed,cert-msc32-c,cert-msc51-cpp)
    std::normal_distribution<double> increment(0.0, std::sqrt(step_s));
    std::array<Moments, rows> moments;
    int lost = 0;
    for (int member = 0; member < members; ++member) {
        SdcomState x = trim;
        bool flies = true;
        for (Moments &row : moments) {
            for (int step = 0; flies && step < steps_per_row; ++step) {
                SdcomNoise dw;
                for (double *it : {&dw.w_gamma, &dw.w_alpha, &dw.w_q, &dw.xi_1, &dw.xi_2, &dw.xi_3}) {
                    *it = increment(source);
                }
                flies = sdcom_euler_maruyama_step(&prepared, &input, &dw, step_s, &x) == 0;
            }
            if (flies) {
                row.add(x.alpha * deg_per_rad);
            }
        }
        lost += flies ? 0 : 1;
    }

    std::printf("alpha of %d members of SDCOM, deg; %d lost\n", members, lost);
    std::printf("   t, s       mean      error  deviation      error\n");
    double t = 0.0;
    for (const Moments &row : moments) {
        t += step_s * steps_per_row;
        std::printf("%7.2f %10.5f %10.5f %10.5f %10.5f\n", t, row.mean(), row.error_of_mean(), row.deviation(),
                    row.error_of_deviation());
    }
    return lost == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
