//! The library crates as a registry would have them: complete, and without a network.

use serde_json::Value;

use crate::shell;

/// How the workspace builds, so that what others wrote is not built a second time.
const AS_THE_WORKSPACE: [&str; 4] = [
    "--config",
    "profile.dev.opt-level=1",
    "--config",
    "profile.dev.debug=false",
];

/// Packages every member that may be published, and with `build` builds each from its package.
pub(crate) fn run(build: bool) -> Result<(), String> {
    let mut cargo = shell::cargo();
    let metadata = shell::output(cargo.args(["metadata", "--no-deps", "--format-version", "1"]))?;
    let metadata: Value = serde_json::from_str(&metadata)
        .map_err(|error| format!("error: cargo metadata: {error}"))?;
    let members = metadata["packages"].as_array().into_iter().flatten();
    let published = members.filter(|it| it["publish"].is_null());
    let mut package = shell::cargo();
    // A user's changes are packaged, too.
    package.args(["package", "--offline", "--locked", "--allow-dirty"]);
    if build {
        package.args(AS_THE_WORKSPACE);
    } else {
        package.arg("--no-verify");
    }
    for member in published {
        package.args(["--package", member["name"].as_str().unwrap_or_default()]);
    }
    shell::run(&mut package)
}
