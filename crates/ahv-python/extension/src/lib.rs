//! The models of this repository, and the commands that are about the paper, as a module of Python.

ahv_python::module! {
    /// The compiled models of the package.
    _models, ahv_models::Models, ahv_paper::commands::all().into(), &[
        include_str!("../../../../generated/ir/com.json"),
        include_str!("../../../../generated/ir/dcom.json"),
        include_str!("../../../../generated/ir/flexible_mode.json"),
    ]
}
