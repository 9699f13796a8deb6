//! Operators of number types, written as functions of their operands.

/// Implements operators of a type: `operators! { Type: Add add(x, y) { .. } Neg neg(x) { .. } }`; those of a type with
/// a parameter: `operators! { impl<L: Lane> Type<L>: .. }`.
#[macro_export]
macro_rules! operators {
    (impl<$parameter:ident: $bound:ident> $type:ty: $($operator:ident $method:ident($x:ident $(, $y:ident)?) $body:block)*) => {$(
        impl<$parameter: $bound> std::ops::$operator for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self $(, $y: Self)?) -> Self {
                let $x = self;
                $body
            }
        }
    )*};
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
