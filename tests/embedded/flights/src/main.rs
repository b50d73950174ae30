//! Prints a flight as this machine computes it: `flights dcom`.

use flights::{Dcom, Ended, Flight, Idle, Sdcom, fly};

fn main() -> Result<(), String> {
    let name = std::env::args().nth(1).unwrap_or_default();
    let text = match name.as_str() {
        Idle::NAME => text::<Idle>(),
        Dcom::NAME => text::<Dcom>(),
        Sdcom::NAME => text::<Sdcom>(),
        _ => return Err(format!("no flight `{name}`")),
    };
    print!("{}", text.map_err(|ended| ended.to_string())?);
    Ok(())
}

fn text<F: Flight>() -> Result<String, Ended> {
    let mut text = String::new();
    fly(&mut text, F::step)?;
    Ok(text)
}
