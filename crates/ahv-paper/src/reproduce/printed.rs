//! What the paper prints, entered once.

/// Greatest error of mean, |e_i^m(t)|, and of standard deviation, |e_i^D(t)|, of the modes: Table 1.
pub const TABLE_1: [(f64, f64); 3] = [(0.016, 0.03), (0.0041, 0.0062), (0.0013, 0.0028)];

/// Runs behind Table 1 and Fig. 2: section 5.1.
pub const TABLE_1_RUNS: u64 = 1000;

/// Runs behind Figs. 3 and 4: section 5.1.
pub const SNAPSHOT_RUNS: u64 = 10_000;

/// Time of Figs. 3 and 4, in s: section 5.1.
pub const SNAPSHOT_TIME: f64 = 10.0;

/// Amplitudes of the generalized forces and intensities of their noise: (37). The frequency is 1 rad/s.
pub const INPUT_37: [(f64, f64); 3] = [(1500.0, 17.0), (500.0, 10.0), (400.0, 10.0)];

/// A trim: Table 2. The table swaps the values of V and h, which are here in their places.
pub struct Trim {
    /// Velocity, in ft/s.
    pub velocity: f64,
    /// Altitude, in ft.
    pub altitude: f64,
    /// Angle of attack, in deg.
    pub alpha_deg: f64,
    /// Fuel equivalence ratio.
    pub phi: f64,
    /// Elevator, in deg; the table gives it no unit.
    pub delta_e_deg: f64,
    /// Flexible coordinates of DCOM and SDCOM, in "ft".
    pub eta: [f64; 3],
    /// Flexible coordinates of FPM and COM, forebody and aftbody, in ft.
    pub eta_cantilever: [f64; 2],
}

/// The trim of Table 2.
pub const TABLE_2: Trim = Trim {
    velocity: 7702.08,
    altitude: 85_000.0,
    alpha_deg: 1.5153,
    phi: 0.2514,
    delta_e_deg: 11.4635,
    eta: [0.827, 0.185, 0.029],
    eta_cantilever: [1.5122, 1.2114],
};

/// A root as [re, im].
pub type Root = [f64; 2];

/// Poles and zeros of a model: a column of Table 3. Of a conjugate pair the one with positive imaginary part.
pub struct Roots {
    /// The model, as this project calls it.
    pub model: &'static str,
    /// Poles, in rad/s.
    pub poles: &'static [Root],
    /// Zeros, in rad/s.
    pub zeros: &'static [Root],
}

/// Table 3. Its first column is headed TM; it is the first-principle model.
pub const TABLE_3: [Roots; 4] = [
    Roots {
        model: "fpm",
        poles: &[
            [-0.54, 19.9],
            [-0.35, 16.2],
            [-1.41, 0.0],
            [1.41, 0.0],
            [-0.000_42, 0.0],
            [-7.5e-5, 0.03],
        ],
        zeros: &[
            [-0.54, 19.6],
            [-0.36, 16.2],
            [2.98, 0.0],
            [-2.98, 0.0],
            [0.0, 0.0],
        ],
    },
    Roots {
        model: "com",
        poles: &[
            [-0.54, 19.6],
            [-0.35, 16.2],
            [-1.83, 0.0],
            [1.83, 0.0],
            [-0.000_58, 0.0],
            [-0.05, 0.02],
        ],
        zeros: &[
            [-0.54, 19.6],
            [-0.36, 16.2],
            [2.98, 0.0],
            [-2.98, 0.0],
            [0.0, 0.0],
        ],
    },
    Roots {
        model: "dcom",
        poles: &[
            [-2.1, 112.5],
            [-1.05, 55.4],
            [-0.41, 25.2],
            [-3.97, 0.0],
            [3.86, 0.0],
            [0.000_56, 0.0],
            [6.2e-4, 0.001],
        ],
        zeros: &[
            [-2.1, 112.5],
            [-1.05, 55.4],
            [-0.41, 22.8],
            [-8.52, 0.0],
            [8.52, 0.0],
            [0.0, 0.0],
        ],
    },
    Roots {
        model: "sdcom",
        poles: &[
            [-1.9, 113.5],
            [-0.95, 55.4],
            [-0.36, 20.1],
            [-4.51, 0.0],
            [4.49, 0.0],
            [0.000_37, 0.0],
            [5.1e-4, 0.001],
        ],
        zeros: &[
            [-1.9, 113.5],
            [-0.95, 55.4],
            [-0.36, 18.5],
            [-9.83, 0.0],
            [9.83, 0.0],
            [0.0, 0.0],
        ],
    },
];
