//! The functions of scalars that an expression may call: their names in the IR, which are the methods of `ahv_core::Real`.

/// A function of one to four scalars.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Call {
    Sin,
    Cos,
    Tan,
    Asin,
    Atan,
    Atan2,
    Exp,
    Tanh,
    Ln,
    /// A real power.
    Powr,
    Sqrt,
    Abs,
    Min,
    Max,
    /// Of a, b, c, d: c where a < b, else d.
    Select,
}

impl Call {
    pub(crate) const ALL: [Self; 15] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Atan,
        Self::Atan2,
        Self::Exp,
        Self::Tanh,
        Self::Ln,
        Self::Powr,
        Self::Sqrt,
        Self::Abs,
        Self::Min,
        Self::Max,
        Self::Select,
    ];

    /// The function of this name with so many arguments.
    pub(crate) fn of(name: &str, arity: usize) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|it| it.name() == name && it.arity() == arity)
    }

    /// Its name in the IR and in Rust; in C `ahv_` stands before it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Atan => "atan",
            Self::Atan2 => "atan2",
            Self::Exp => "exp",
            Self::Tanh => "tanh",
            Self::Ln => "ln",
            Self::Powr => "powr",
            Self::Sqrt => "sqrt",
            Self::Abs => "abs",
            Self::Min => "min",
            Self::Max => "max",
            Self::Select => "select",
        }
    }

    /// How many arguments it has.
    pub(crate) const fn arity(self) -> usize {
        match self {
            Self::Select => 4,
            Self::Atan2 | Self::Powr | Self::Min | Self::Max => 2,
            _ => 1,
        }
    }
}
