//! Degrees of the solutions that elements of one order are to follow well.

/// How many there are.
pub const DEGREES: usize = 3;

/// A number for each of them.
pub type PerDegree = [f64; DEGREES];

/// As shares of the elements' order: the order itself, and lower ones, which see modes of the elements' maps that their
/// own degree does not contain.
const SHARES: PerDegree = [1.0, 0.7, 0.4];

/// Those of elements of order `order`, at least 1.
pub fn solution_degrees(order: usize) -> [usize; DEGREES] {
    SHARES.map(|share| ((share * order as f64).round() as usize).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_shares_of_the_order_and_at_least_1() {
        assert_eq!(solution_degrees(10), [10, 7, 4]);
        assert_eq!(solution_degrees(1), [1, 1, 1]);
    }
}
