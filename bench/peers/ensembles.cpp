// Ensembles in C++: the standard library's normal numbers, one generator a thread.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <thread>
#include <vector>

// CasADi's step, so that the compiler sees into it.
#include "euler_maruyama.c"

namespace {

constexpr int STATES = 8;
constexpr int CHANNELS = 6;
constexpr int MODES = 3;
constexpr int INPUTS = 3;
// Of each input: whether it moves, its bounds, then its gains.
constexpr int ROW = 3 + STATES;
constexpr int ALPHA = 3;
// Sums of eta, its square, chi and its square.
constexpr int SUMS = 4;

// Calls `work(thread, first, end, random)` for equal parts of `count`, one a thread.
void in_parts(int threads, int count, std::uint64_t seed,
              const std::function<void(int, int, int, std::mt19937_64 &)> &work) {
    std::vector<std::thread> running;
    for (int k = 0; k < threads; ++k) {
        running.emplace_back([=, &work] {
            std::seed_seq mixed{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                                static_cast<std::uint32_t>(k)};
            std::mt19937_64 random(mixed);
            work(k, static_cast<int>(static_cast<std::int64_t>(count) * k / threads),
                 static_cast<int>(static_cast<std::int64_t>(count) * (k + 1) / threads), random);
        });
    }
    for (auto &thread : running) thread.join();
}

}  // namespace

// Flights of SDCOM by the Euler-Maruyama method; `ends` takes the states, member by member.
extern "C" void monte_carlo(const double *start, const double *u, const double *p, double dt, int steps, int members,
                            int threads, std::uint64_t seed, double *ends) {
    in_parts(threads, members, seed, [=](int, int first, int end, std::mt19937_64 &random) {
        std::normal_distribution<double> normal(0.0, std::sqrt(dt));
        for (int member = first; member < end; ++member) {
            std::array<double, STATES> x, after;
            std::array<double, CHANNELS> dw;
            std::copy(start, start + STATES, x.begin());
            for (int k = 0; k < steps; ++k) {
                for (double &it : dw) it = normal(random);
                const double *arguments[] = {x.data(), u, p, &dt, dw.data()};
                double *results[] = {after.data()};
                // Its `_work` asks for no memory.
                sdcom_euler_maruyama(arguments, results, nullptr, nullptr, 0);
                x = after;
            }
            std::copy(x.begin(), x.end(), ends + static_cast<std::ptrdiff_t>(member) * STATES);
        }
    });
}

// Flights of SDCOM by the Euler-Maruyama method under u = input - gain (x - start), held over a step, through lags with limits
// of position and of `rate`; `law` holds a row an input. The increments of a step are each the sum of `parts` normal numbers.
// `ends` takes the angles of attack.
extern "C" void closed_loop(const double *start, const double *u, const double *p, const double *law, double bandwidth,
                            double rate, double dt, int steps, int parts, int members, int threads, std::uint64_t seed,
                            double *ends) {
    const double share = -std::expm1(-bandwidth * dt), most = rate * dt;
    in_parts(threads, members, seed, [=](int, int first, int end, std::mt19937_64 &random) {
        std::normal_distribution<double> normal(0.0, std::sqrt(dt / parts));
        for (int member = first; member < end; ++member) {
            std::array<double, STATES> x, after;
            std::array<double, INPUTS> position;
            std::copy(start, start + STATES, x.begin());
            std::copy(u, u + INPUTS, position.begin());
            for (int k = 0; k < steps; ++k) {
                for (int input = 0; input < INPUTS; ++input) {
                    const double *row = law + ROW * input;
                    if (row[0] == 0.0) continue;
                    double command = u[input];
                    for (int state = 0; state < STATES; ++state) command -= row[3 + state] * (x[state] - start[state]);
                    const double wanted = (std::clamp(command, row[1], row[2]) - position[input]) * share;
                    position[input] += std::clamp(wanted, -most, most);
                }
                std::array<double, CHANNELS> dw{};
                for (int part = 0; part < parts; ++part)
                    for (double &it : dw) it += normal(random);
                const double *arguments[] = {x.data(), position.data(), p, &dt, dw.data()};
                double *results[] = {after.data()};
                sdcom_euler_maruyama(arguments, results, nullptr, nullptr, 0);
                x = after;
            }
            ends[member] = x[ALPHA];
        }
    });
}

// Ensembles of modes, each with stiffness, damping, sigma, decay and intensity in `rates`; `sums` holds what each thread has
// summed after each step: threads by modes by steps by four.
extern "C" void modes(const double *rates, double dt, int steps, int runs, int threads, std::uint64_t seed,
                      double *sums) {
    in_parts(threads, runs, seed, [=](int thread, int first, int end, std::mt19937_64 &random) {
        std::normal_distribution<double> normal(0.0, std::sqrt(dt));
        for (int mode = 0; mode < MODES; ++mode) {
            const double *r = rates + 5 * mode;
            const double stiffness = r[0], damping = r[1], sigma = r[2], decay = r[3], intensity = r[4];
            double *own = sums + static_cast<std::ptrdiff_t>(thread * MODES + mode) * steps * SUMS;
            for (int run = first; run < end; ++run) {
                double eta = 0.0, eta_dot = 0.0, chi = 0.0;
                for (int k = 0; k < steps; ++k) {
                    const double dw = normal(random);
                    const double acceleration = -stiffness * eta - damping * eta_dot;
                    eta += dt * eta_dot;
                    eta_dot += dt * acceleration + sigma * dw;
                    chi += -dt * decay * chi + intensity * dw;
                    double *row = own + SUMS * k;
                    row[0] += eta;
                    row[1] += eta * eta;
                    row[2] += chi;
                    row[3] += chi * chi;
                }
            }
        }
    });
}
