//! The elementary functions in C, `templates/c/ahv_elementary.c`, have the bits of `ahv_core::Real` for doubles.
//!
//! The tests need a C compiler, `cc` or what the variable `CC` names, and fail without one. Where `clang` and a C++
//! compiler are found, they are tested too.
#![forbid(unsafe_code)]

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs, thread};

use ahv_core::Real;

/// How generated C is compiled: what may not warn, and what keeps the bits.
const STRICT: [&str; 8] = [
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Wdouble-promotion",
    "-Werror",
    "-ffp-contract=off",
];

/// The results that `c_elementary/driver.c` writes for each value.
const RESULTS: [&str; 18] = [
    "exp",
    "sin",
    "cos",
    "sine of sin_cos",
    "cosine of sin_cos",
    "sqrt",
    "recip",
    "tan",
    "asin",
    "atan",
    "tanh",
    "ln",
    "abs",
    "atan2",
    "powr",
    "min",
    "max",
    "select",
];

const WORD: usize = size_of::<f64>();

/// Values that are compared between two looks at the program's output.
const BLOCK: usize = 4096;

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("templates/c")
}

fn driver() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c_elementary/driver.c")
}

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("cargo's folder for tests is writable");
    path
}

fn is_found(compiler: &str) -> bool {
    Command::new(compiler)
        .arg("--version")
        .output()
        .is_ok_and(|output| output.status.success())
}

fn c_compiler() -> String {
    let compiler = env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    assert!(
        is_found(&compiler),
        "`{compiler} --version` does not run: this test needs a C99 compiler; install gcc or clang, or set CC"
    );
    compiler
}

/// Compiles the files; says what the compiler says if it fails.
fn compile(
    compiler: &str,
    flags: &[&str],
    files: &[PathBuf],
    program: &Path,
) -> Result<(), String> {
    let output = Command::new(compiler)
        .args(flags)
        .arg("-I")
        .arg(sources())
        .args(files)
        .arg("-o")
        .arg(program)
        .arg("-lm")
        .output()
        .map_err(|error| format!("{compiler}: {error}"))?;
    output.status.success().then_some(()).ok_or_else(|| {
        let said = String::from_utf8_lossy(&output.stderr);
        format!("`{compiler} {}` failed:\n{said}", flags.join(" "))
    })
}

/// The driver with the elementary functions, compiled with the strict flags and `flags`.
fn program(compiler: &str, flags: &[&str], folder: &Path) -> PathBuf {
    let program = folder.join(flags.concat());
    let flags: Vec<&str> = flags.iter().chain(&STRICT).copied().collect();
    let files = [driver(), sources().join("ahv_elementary.c")];
    compile(compiler, &flags, &files, &program).unwrap_or_else(|error| panic!("{error}"));
    program
}

fn expected(x: f64, y: f64) -> [f64; 18] {
    let (sin, cos) = Real::sin_cos(x);
    [
        Real::exp(x),
        Real::sin(x),
        Real::cos(x),
        sin,
        cos,
        Real::sqrt(x),
        Real::recip(x),
        Real::tan(x),
        Real::asin(x),
        Real::atan(x),
        Real::tanh(x),
        Real::ln(x),
        Real::abs(x),
        Real::atan2(x, y),
        Real::powr(x, y),
        <f64 as Real>::min(x, y),
        <f64 as Real>::max(x, y),
        Real::select(x, y, 1.0, x),
    ]
}

/// The first value at which the program has other bits than `ahv_core`. Every NaN is the same.
fn difference(program: &Path, values: &[f64]) -> Option<String> {
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the compiled driver starts");
    let mut input = child.stdin.take().expect("it is piped");
    let mut output = child.stdout.take().expect("it is piped");
    let found = thread::scope(|scope| {
        scope.spawn(move || {
            for block in values.chunks(BLOCK) {
                let bytes: Vec<u8> = block.iter().flat_map(|x| x.to_ne_bytes()).collect();
                // The reader notices if the driver has ended.
                if input.write_all(&bytes).is_err() {
                    return;
                }
            }
        });
        let mut found = None;
        for block in values.chunks(BLOCK) {
            let mut bytes = vec![0; block.len() * RESULTS.len() * WORD];
            output
                .read_exact(&mut bytes)
                .expect("the driver writes its results for each value");
            found = found.or_else(|| difference_in(block, &bytes));
        }
        found
    });
    let status = child.wait().expect("the driver ends");
    assert!(status.success(), "the driver ended with {status}");
    found
}

fn difference_in(values: &[f64], bytes: &[u8]) -> Option<String> {
    let pairs = values.iter().zip(values.iter().rev());
    for ((&x, &y), results) in pairs.zip(bytes.chunks(RESULTS.len() * WORD)) {
        let results = results.chunks(WORD).map(|word| {
            f64::from_ne_bytes(word.try_into().expect("a chunk has the length of a double"))
        });
        for ((name, rust), c) in RESULTS.iter().zip(expected(x, y)).zip(results) {
            if rust.to_bits() != c.to_bits() && !(rust.is_nan() && c.is_nan()) {
                return Some(format!(
                    "{name} at {x:?} ({:#018x}), {y:?}: Rust gives {rust:?} ({:#018x}), C gives {c:?} ({:#018x})",
                    x.to_bits(),
                    rust.to_bits(),
                    c.to_bits()
                ));
            }
        }
    }
    None
}

/// Random bits by SplitMix64.
struct Bits(u64);

impl Bits {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number between two others.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        let fraction = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        low + fraction * (high - low)
    }
}

/// A number and its neighbours.
fn around(x: f64) -> impl Iterator<Item = f64> {
    let bits = x.to_bits();
    (0..9).map(move |step| f64::from_bits(bits.wrapping_add(step).wrapping_sub(4)))
}

/// Doubles next to a multiple of π/2, on either side, by their bits. The first 1 to 61 bits of the fraction of a
/// quarter turn agree. Found by convergents of 2ᵉ · 2/π.
const NEXT_TO_QUARTER_TURNS: [u64; 21] = [
    0x7506_ac5b_262c_a1ff,
    0x7516_ac5b_262c_a1ff,
    0x416b_951f_1572_eba5,
    0x6dc8_1705_0190_d2a4,
    0x7693_c66b_5249_97ab,
    0x55ae_a4d8_76f4_0747,
    0x716f_3e93_586c_931b,
    0x5b80_2bf4_e681_6e1f,
    0x6840_36bb_0b62_2e7d,
    0x777f_ff8e_1fa4_0c50,
    0x503f_fde2_5437_7c8e,
    0x77df_ff8e_1fa4_0c50,
    0x510f_fdce_5c02_6b63,
    0x7edf_fff1_a841_4b79,
    0x5caf_ffd6_5c34_9a11,
    0x606f_fffb_a2a2_7256,
    0x58df_ffff_dce9_a061,
    0x7b60_0000_c573_9868,
    0x686f_ffff_5a51_e0eb,
    0x4acf_ffff_e92d_912d,
    0x4a40_0000_1475_3082,
];

/// Where a function has an edge or goes another way, with neighbours and both signs.
fn edges() -> Vec<f64> {
    let single = [
        0.0,
        f64::from_bits(1),
        f64::MIN_POSITIVE,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
        1.0,
        // Where tangents, inverses and logarithm go other ways.
        0.414_213_562_373_095_03,
        2.414_213_562_373_095,
        std::f64::consts::SQRT_2,
        20.0,
        9.313_225_746_154_785e-10,
        1.152_921_504_606_847e18,
        // The angles at which reductions change.
        FRAC_PI_4,
        1e6,
        f64::from_bits(0x4139_21fb_0000_0000),
        // The exponents at which the exponential changes, overflows, becomes subnormal and 0.
        708.0,
        708.396_418_532_264_1,
        709.782_712_893_384,
        710.0,
        744.440_071_921_381_3,
        745.133_219_101_941_1,
        746.0,
    ];
    let powers = (-1074..1024).map(|exponent| 2.0_f64.powi(exponent));
    let hard = NEXT_TO_QUARTER_TURNS.map(f64::from_bits);
    let eighths = (1..20_000).map(|turns| f64::from(turns) * FRAC_PI_4);
    // The last parts of π/2 and the first digits meet between these.
    let quarters = (1_048_000..1_049_000).map(|turns| f64::from(turns) * FRAC_PI_2);
    let halves_of_ln_2 = (0..2200).map(|k| f64::from(k) * (std::f64::consts::LN_2 / 2.0));
    single
        .into_iter()
        .chain(powers)
        .chain(hard)
        .chain(eighths)
        .chain(quarters)
        .chain(halves_of_ln_2)
        .flat_map(around)
        .flat_map(|x| [x, -x])
        .collect()
}

/// Edges, random bits and random numbers of the ranges that a function treats alike.
fn values(count: usize) -> Vec<f64> {
    let mut bits = Bits(15);
    let mut values = edges();
    let ranges = [
        (-FRAC_PI_4, FRAC_PI_4),
        (-10.0, 10.0),
        (-1.0, 1.0),
        (0.0, 10.0),
        (-1e6, 1e6),
        (1e6, 1.7e6),
        (1.6e6, 1e10),
        (-710.0, 710.0),
        (-747.0, -707.0),
        (707.0, 711.0),
    ];
    for (low, high) in ranges {
        values.extend((0..count / ranges.len()).map(|_| bits.between(low, high)));
    }
    values.extend((0..count).map(|_| f64::from_bits(bits.next())));
    values
}

/// Compiles with each of the sets of flags and compares two million values.
fn compare(compiler: &str, variants: &[&[&str]], folder: &Path) {
    let values = values(1_000_000);
    for flags in variants {
        let program = program(compiler, flags, folder);
        if let Some(difference) = difference(&program, &values) {
            panic!("{compiler} {}: {difference}", flags.join(" "));
        }
        println!(
            "{compiler} {}: the bits of {} values",
            flags.join(" "),
            values.len()
        );
    }
}

/// Whether the compiler knows these flags on this machine.
fn takes(compiler: &str, flags: &[&str], folder: &Path) -> bool {
    let empty = folder.join("empty.c");
    fs::write(&empty, "int main(void) { return 0; }\n").expect("the folder is writable");
    compile(compiler, flags, &[empty], &folder.join("empty")).is_ok()
}

#[test]
fn c_has_the_bits_of_rust() {
    let (compiler, folder) = (c_compiler(), folder("c"));
    compare(
        &compiler,
        &[&["-std=c99", "-O0"], &["-std=c99", "-O2"]],
        &folder,
    );
    // With the instructions of this machine, among them fused multiply-adds.
    let native = ["-std=c99", "-O3", "-march=native"];
    if takes(&compiler, &native, &folder) {
        compare(&compiler, &[&native], &folder);
    } else {
        println!("{compiler} does not take -march=native");
    }
}

#[test]
fn clang_has_the_bits_of_rust() {
    if is_found("clang") {
        compare(
            "clang",
            &[&["-std=c99", "-O0"], &["-std=c99", "-O2"]],
            &folder("clang"),
        );
    } else {
        println!("clang is not found");
    }
}

#[test]
fn c_compiled_as_cpp_has_the_bits_of_rust() {
    if is_found("c++") {
        compare(
            "c++",
            &[&["-x", "c++", "-std=c++11", "-O2"]],
            &folder("cpp"),
        );
    } else {
        println!("c++ is not found");
    }
}

/// Without `-ffp-contract=off`, in a dialect in which gcc contracts.
#[test]
fn bits_hold_where_the_flag_against_contraction_is_forgotten() {
    let (compiler, folder) = (c_compiler(), folder("contraction"));
    let flags = ["-std=gnu99", "-O2", "-march=native"];
    if !takes(&compiler, &flags, &folder) {
        println!("{compiler} does not take -march=native");
        return;
    }
    let program = folder.join("contraction");
    let files = [driver(), sources().join("ahv_elementary.c")];
    compile(&compiler, &flags, &files, &program).unwrap_or_else(|error| panic!("{error}"));
    if let Some(difference) = difference(&program, &values(100_000)) {
        panic!("{compiler} {}: {difference}", flags.join(" "));
    }
}

/// A comparison that would miss a wrong coefficient proves nothing.
#[test]
fn wrong_coefficient_is_found() {
    let (compiler, folder) = (c_compiler(), folder("wrong"));
    let text = fs::read_to_string(sources().join("ahv_elementary.c")).expect("it is there");
    let values = values(100_000);
    // A late digit: the very last of a coefficient of a high power changes few results.
    for (right, wrong) in [
        ("-0.16666666666666644", "-0.16666666666666647"),
        ("0.041666666666530155", "0.041666666666530165"),
        ("2.0222662487111665e-21", "2.0222662487111669e-21"),
        ("-0.0027777777777015593", "-0.0027777777787015593"),
        ("-2.5050760253406863e-08", "-2.5050760293406863e-08"),
        ("0xF17B3DU", "0xF17B3CU"),
    ] {
        let changed = text.replace(right, wrong);
        assert_ne!(changed, text, "{right} is not in the file");
        let file = folder.join("wrong.c");
        fs::write(&file, changed).expect("the folder is writable");
        let program = folder.join("wrong");
        let flags = ["-std=c99", "-O1", "-ffp-contract=off"];
        compile(&compiler, &flags, &[driver(), file], &program)
            .unwrap_or_else(|error| panic!("{error}"));
        assert!(
            difference(&program, &values).is_some(),
            "nothing differs with {wrong} instead of {right}"
        );
    }
}

/// The doubles of a text.
fn doubles(text: &str) -> BTreeSet<u64> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "._+-".contains(c);
    text.split(|c| !is_part(c))
        .filter(|word| word.contains('.'))
        .filter_map(|word| word.replace('_', "").parse::<f64>().ok())
        .map(f64::to_bits)
        .collect()
}

/// A wrong last bit in the coefficient of a high power changes few results: the constants themselves are compared.
#[test]
fn constants_are_those_of_rust() {
    let files = [
        include_str!("../../ahv-core/src/elementary/double.rs"),
        include_str!("../../ahv-core/src/elementary/reduction.rs"),
        include_str!("../../ahv-core/src/elementary/tangent.rs"),
        include_str!("../../ahv-core/src/elementary/arc.rs"),
        include_str!("../../ahv-core/src/elementary/logarithm.rs"),
    ];
    let rust: BTreeSet<u64> = files
        .into_iter()
        .filter_map(|text| text.split("impl Lane").next())
        .flat_map(doubles)
        .collect();
    let c = doubles(include_str!("../templates/c/ahv_elementary.c"));
    assert!(rust.len() > 60, "the constants are not found");
    let missing: Vec<f64> = rust.difference(&c).copied().map(f64::from_bits).collect();
    assert!(missing.is_empty(), "C lacks {missing:?}");
}

#[test]
fn flags_that_change_bits_are_refused() {
    let (compiler, folder) = (c_compiler(), folder("refused"));
    for flags in [
        ["-std=c99", "-ffast-math"],
        ["-std=c99", "-Ofast"],
        ["-std=c99", "-ffinite-math-only"],
        ["-std=c99", "-mfpmath=387"],
    ] {
        if !takes(&compiler, &flags, &folder) {
            println!("{compiler} does not take {}", flags[1]);
            continue;
        }
        let files = [driver(), sources().join("ahv_elementary.c")];
        let said = compile(&compiler, &flags, &files, &folder.join("refused"))
            .expect_err("the header refuses these flags");
        assert!(said.contains("ahv: "), "{}: {said}", flags[1]);
    }
}
