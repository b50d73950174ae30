//! {{ about }}.
//!
//! Units are {{ units }}; every field says its own.
//! Every function is generic over the scalar ([`ahv_core::Real`]), has no branches and no heap, and follows IEEE
//! arithmetic: outside a model's domain a result may be infinite or NaN.
#![no_std]
#![forbid(unsafe_code)]
#![allow(clippy::approx_constant, reason = "numbers of tables")]

{%- for module in modules %}
/// {{ module.doc }}
#[rustfmt::skip]
pub mod {{ module.name }};
{%- endfor %}

/// The models of this package.
#[derive(Clone, Copy, Debug)]
pub struct Models;

impl ahv_core::ModelList for Models {
    fn visit(visitor: &mut impl ahv_core::ModelVisitor) {
{%- for module in modules %}
        visitor.visit::<{{ module.name }}::Model<f64>>();
{%- endfor %}
    }
}
