//! The unit of an entry.
#![no_main]

use ahv_table::Unit;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Some(unit) = Unit::parse(text) else {
        return;
    };
    // A unit may be too large or too small for a number; what has a size is one of itself.
    if let Some(size) = unit.in_terms_of(&unit)
        && !size.is_nan()
    {
        assert_eq!(size, 1.0, "{text}");
    }
});
