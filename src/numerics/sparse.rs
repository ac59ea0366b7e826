//! Sparse symmetric positive definite systems: one analysis, a factorisation for each set of values, many solves.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{Argsort, Pair, SparseColMat, SymbolicSparseColMat};
use faer::{Mat, Side};

/// Where a matrix has entries, and the order in which it is eliminated.
#[derive(Debug, Clone)]
pub struct Pattern {
    size: usize,
    /// Entries that the values are given for; those of the same place are added up.
    entries: usize,
    matrix: SymbolicSparseColMat<u32>,
    order: Argsort<u32>,
    elimination: SymbolicLlt<u32>,
}

/// The Cholesky factors of a sparse symmetric positive definite matrix.
///
/// The order of elimination (approximate minimum degree) and every sum in it depend on the matrix
/// alone and run on one thread, so the same matrix gives the same bits.
#[derive(Debug, Clone)]
pub struct Cholesky {
    size: usize,
    factors: Llt<u32, f64>,
}

/// Row and column of an entry of the lower triangle.
pub type Place = (u32, u32);

impl Pattern {
    /// For `size` × `size` matrices whose lower triangle (row ≥ column) is the sum of entries at `places`.
    ///
    /// `Err` says in words what is wrong: an index out of range, an entry above the diagonal, or too little memory.
    pub fn new(size: usize, places: &[Place]) -> Result<Pattern, String> {
        if let Some((row, column)) = places.iter().find(|(row, column)| *row as usize >= size || column > row)
        {
            return Err(format!("entry ({row}, {column}) is outside the lower triangle of size {size}"));
        }
        let pairs: Vec<_> = places.iter().map(|&(row, col)| Pair { row, col }).collect();
        let (matrix, order) = SymbolicSparseColMat::try_new_from_indices(size, size, &pairs)
            .map_err(|e| format!("sparse matrix: {e:?}"))?;
        let elimination =
            SymbolicLlt::try_new(matrix.as_ref(), Side::Lower).map_err(|e| format!("ordering: {e:?}"))?;
        Ok(Pattern { size, entries: places.len(), matrix, order, elimination })
    }

    /// Factors the matrix with these values at the places that the pattern was made for, in their order.
    ///
    /// `Err` says in words what is wrong: another number of values, one that is not finite, a matrix that is not
    /// positive definite, or too little memory.
    pub fn factor(&self, values: &[f64]) -> Result<Cholesky, String> {
        if values.len() != self.entries {
            return Err(format!("{} values for {} entries", values.len(), self.entries));
        }
        if let Some(i) = values.iter().position(|value| !value.is_finite()) {
            return Err(format!("entry {i} is not finite"));
        }
        let matrix = SparseColMat::new_from_argsort(self.matrix.clone(), &self.order, values)
            .map_err(|e| format!("sparse matrix: {e:?}"))?;
        let factors = Llt::try_new_with_symbolic(self.elimination.clone(), matrix.as_ref(), Side::Lower)
            .map_err(|e| format!("Cholesky: {e:?}"))?;
        Ok(Cholesky { size: self.size, factors })
    }
}

impl Cholesky {
    /// Solves for `K` right-hand sides at once: `b[i][k]` is row i of the k-th.
    ///
    /// `Err` if the length of `b` is not the matrix's size or the solution is not finite.
    pub fn solve<const K: usize>(&self, b: &[[f64; K]]) -> Result<Vec<[f64; K]>, String> {
        if b.len() != self.size {
            return Err(format!("right-hand side of length {} for size {}", b.len(), self.size));
        }
        if self.size == 0 {
            return Ok(Vec::new());
        }
        let mut x = Mat::from_fn(self.size, K, |i, k| b[i][k]);
        self.factors.solve_in_place(x.as_mut());
        let solution: Vec<[f64; K]> = (0..self.size).map(|i| std::array::from_fn(|k| x[(i, k)])).collect();
        match solution.iter().flatten().all(|v| v.is_finite()) {
            true => Ok(solution),
            false => Err("the solution is not finite".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pattern and values of the second difference, times `scale`.
    fn second_difference(n: usize, scale: f64) -> (Vec<Place>, Vec<f64>) {
        let (mut places, mut values) = (Vec::new(), Vec::new());
        for i in 0..n as u32 {
            // The diagonal in two halves: repeated entries have to add up.
            places.extend([(i, i), (i, i)]);
            values.extend([scale, scale]);
            if i > 0 {
                places.push((i, i - 1));
                values.push(-scale);
            }
        }
        (places, values)
    }

    #[test]
    fn solves_two_right_hand_sides() {
        let n = 500;
        let (places, values) = second_difference(n, 1.0);
        let pattern = Pattern::new(n, &places).unwrap();
        let exact: Vec<[f64; 2]> = (0..n).map(|i| [(i as f64 * 0.1).sin(), i as f64]).collect();
        let at = |i: isize, k: usize| match usize::try_from(i).ok().filter(|&i| i < n) {
            Some(i) => exact[i][k],
            None => 0.0,
        };
        let b: Vec<[f64; 2]> = (0..n as isize)
            .map(|i| std::array::from_fn(|k| 2.0 * at(i, k) - at(i - 1, k) - at(i + 1, k)))
            .collect();
        let x = pattern.factor(&values).unwrap().solve(&b).unwrap();
        for (x, e) in x.iter().zip(&exact) {
            assert!((x[0] - e[0]).abs() < 1e-8 && (x[1] - e[1]).abs() < 1e-6, "{x:?} {e:?}");
        }
        assert_eq!(x, Pattern::new(n, &places).unwrap().factor(&values).unwrap().solve(&b).unwrap());
        // The same pattern with other values.
        let halves = pattern.factor(&second_difference(n, 2.0).1).unwrap().solve(&b).unwrap();
        for (x, e) in halves.iter().zip(&exact) {
            assert!((2.0 * x[0] - e[0]).abs() < 1e-8, "{x:?} {e:?}");
        }
    }

    #[test]
    fn refuses_what_it_cannot_factor() {
        assert!(Pattern::new(2, &[(0, 0), (1, 1)]).unwrap().factor(&[1.0, -1.0]).is_err());
        assert!(Pattern::new(2, &[(0, 0), (0, 1)]).is_err());
        assert!(Pattern::new(1, &[(1, 0)]).is_err());
        let one = Pattern::new(1, &[(0, 0)]).unwrap();
        assert!(one.factor(&[f64::NAN]).is_err());
        assert!(one.factor(&[1.0, 1.0]).is_err());
        assert!(one.factor(&[1.0]).unwrap().solve(&[[1.0], [2.0]]).is_err());
        let none = Pattern::new(0, &[]).unwrap().factor(&[]).unwrap();
        assert_eq!(none.solve::<1>(&[]).unwrap(), Vec::<[f64; 1]>::new());
    }
}
