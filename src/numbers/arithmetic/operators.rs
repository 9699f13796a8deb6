//! Operators of number types, written as functions of their operands.

/// Implements operators of a type: `operators! { Type: Add add(x, y) { .. } Neg neg(x) { .. } }`.
#[macro_export]
macro_rules! operators {
    ($type:ty: $($(#[$doc:meta])* $operator:ident $method:ident($x:ident $(, $y:ident)?) $body:block)*) => {$(
        $(#[$doc])*
        impl std::ops::$operator for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self $(, $y: Self)?) -> Self {
                let $x = self;
                $body
            }
        }
    )*};
}
