//! A file of gains, as `--feedback` reads it: through the command, up to one step of one flight.
#![no_main]

use std::fs;
use std::sync::LazyLock;

use ahv_cli::embedded;
use ahv_cli::failure::Failure;
use ahv_core::{ModelList, ModelVisitor};
use ahv_models::com_rigid;
use libfuzzer_sys::fuzz_target;

/// The smallest model that trims.
struct Models;

impl ModelList for Models {
    fn visit(visitor: &mut impl ModelVisitor) {
        visitor.visit::<com_rigid::Model<f64>>();
    }
}

const COMMAND: &str = "montecarlo --model com_rigid --stochastic --members 2 --t-end 0.01 --dt 0.01 --threads 1 \
                       --feedback-mismatch allow --feedback";

fuzz_target!(|text: &[u8]| {
    static FILE: LazyLock<String> = LazyLock::new(|| {
        embedded::register::<Models>();
        let file = std::env::temp_dir().join(format!("ahv-fuzz-{}.json", std::process::id()));
        file.display().to_string()
    });
    fs::write(&*FILE, text).expect("a folder for temporary files");
    let words = COMMAND.split(' ').map(str::to_owned);
    let told = embedded::tell(words.chain([FILE.clone()]).collect(), &[]);
    assert!(!told.text.contains("NaN"), "{}", told.text);
    if let Err(Failure::Request(message) | Failure::Numeric(message)) = told.end {
        assert!(!message.is_empty());
    }
});
