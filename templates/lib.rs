//! Models of a flexible air-breathing hypersonic vehicle, generated from tables of curve-fitted coefficients.
//!
//! Units are {{ units }}; forces, mass and inertia are per unit of vehicle width.
//! Every function is generic over the scalar ([`ahv_core::Real`]), has no branches and no heap, and follows IEEE
//! arithmetic: outside a model's domain (velocity > 0) a result may be infinite or NaN.
#![no_std]
#![forbid(unsafe_code)]

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
