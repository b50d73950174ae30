//! A table, as `--table` and `ahv generate` read it: its places, its values, and the check against the models of this repository.
#![no_main]

use ahv_models::{com_rigid, dcom, flexible_mode};
use ahv_table::{Family, Part, Text, check};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(parsed) = Text::parse(text.to_owned()) else {
        return;
    };
    let families = [
        Family::of::<dcom::Model<f64>>(),
        Family::of::<com_rigid::Model<f64>>(),
        Family::of::<flexible_mode::Model<f64>>(),
    ];
    match check(&parsed, &families) {
        Ok(checked) => {
            let entries = checked.sets.iter().flat_map(|set| &set.entries);
            assert!(entries.flatten().all(|entry| entry.value.is_finite()));
        }
        Err(faults) => {
            assert!(!faults.is_empty(), "refused without a fault");
            for fault in faults {
                assert!(!fault.to_string().is_empty());
                let path: Vec<&str> = fault.path.iter().map(String::as_str).collect();
                let span = parsed.span(&path, Part::Value);
                assert!(
                    span.is_none_or(|it| text.get(it).is_some()),
                    "no place: {fault}"
                );
            }
        }
    }
});
