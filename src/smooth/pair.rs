//! Two numbers at once, which the compiler keeps in one vector register.

use std::ops::{Add, Div, Mul, Sub};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pair(pub [f64; 2]);

impl Pair {
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Pair([x, x])
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Pair([self.0[0].sqrt(), self.0[1].sqrt()])
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Pair([self.0[0].abs(), self.0[1].abs()])
    }

    /// The smaller of the two in each place; a NaN in `other` is passed over.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        let least = |a: f64, b: f64| if b < a { b } else { a };
        Pair([least(self.0[0], other.0[0]), least(self.0[1], other.0[1])])
    }

    /// `yes` where this is positive, else `no`.
    #[inline(always)]
    pub fn choose_positive(self, yes: Self, no: Self) -> Self {
        let choose = |x: f64, a: f64, b: f64| if x > 0.0 { a } else { b };
        Pair([choose(self.0[0], yes.0[0], no.0[0]), choose(self.0[1], yes.0[1], no.0[1])])
    }

    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.0[0] + self.0[1]
    }

    /// The smaller of its two numbers.
    #[inline(always)]
    pub fn least(self) -> f64 {
        self.0[0].min(self.0[1])
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident, $op:tt) => {
        impl $trait for Pair {
            type Output = Pair;
            #[inline(always)]
            fn $function(self, other: Pair) -> Pair {
                Pair([self.0[0] $op other.0[0], self.0[1] $op other.0[1]])
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);
