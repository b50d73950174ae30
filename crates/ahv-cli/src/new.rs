//! `ahv new`: the command line and the act itself are those of `ahv-new`.

pub(crate) use ahv_new::Args as Arguments;

/// Runs the command, which says for itself what it wrote or why it refused.
pub(crate) fn run(arguments: &Arguments) -> u8 {
    ahv_new::run(arguments)
}
