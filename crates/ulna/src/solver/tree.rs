//! The triangle of rows that come and go.
//!
//! Rows stand in leaves; above each two stands the triangle of both, up to a root, the triangle of all. Who changes one
//! leaf folds the way up from it anew, a few triangles, however many rows there are: rows are taken away without ever being
//! subtracted, so what is left is as exact as if they had never come. (The product of reflections in a tree is that of
//! Demmel, Grigori, Hoemmen and Langou 2012, "Communication-optimal parallel and sequential QR".)

use super::triangle::{Folding, Triangle};

/// Leaves of rows and the triangles above them.
#[derive(Debug, Clone)]
pub struct TriangleTree {
    unknowns: usize,
    /// leaves first; each row-major as a [`Triangle`]'s, none where nothing is
    levels: Vec<Vec<Node>>,
    fold: Folding,
}

#[derive(Debug, Clone, Default)]
struct Node {
    top: Option<Vec<f64>>,
    /// something below has changed
    stale: bool,
}

impl TriangleTree {
    /// Without rows, for a number of unknowns.
    pub fn new(unknowns: usize) -> TriangleTree {
        TriangleTree { unknowns, levels: vec![vec![]], fold: Folding::new(unknowns + 1) }
    }

    /// How many leaves there are, with the empty ones.
    pub fn leaves(&self) -> usize {
        self.levels[0].len()
    }

    /// Puts rows into a leaf, in place of those that it held; leaves up to it are there from then on, empty. None: empties it.
    ///
    /// # Panics
    /// Where the rows are of another number of unknowns.
    pub fn put(&mut self, leaf: usize, rows: Option<&Triangle>) {
        assert!(rows.is_none_or(|rows| rows.unknowns() == self.unknowns), "rows of other unknowns");
        self.put_entries(leaf, rows.map(|rows| rows.entries().to_vec()));
    }

    fn put_entries(&mut self, leaf: usize, top: Option<Vec<f64>>) {
        while self.levels[0].len() <= leaf {
            self.levels[0].push(Node::default());
        }
        self.levels[0][leaf].top = top;
        let (mut level, mut node) = (0, leaf);
        while self.levels[level].len() > 1 {
            (level, node) = (level + 1, node / 2);
            if self.levels.len() == level {
                // what was the root so far is below the new one
                self.levels.push(vec![Node { top: None, stale: true }]);
            }
            while self.levels[level].len() <= node {
                self.levels[level].push(Node::default());
            }
            self.levels[level][node].stale = true;
        }
    }

    /// The triangle of all rows but those of a leaf.
    pub fn root_without(&mut self, leaf: usize) -> Triangle {
        let Some(top) = self.levels[0].get(leaf).and_then(|node| node.top.clone()) else { return self.root() };
        self.put_entries(leaf, None);
        let root = self.root();
        self.put_entries(leaf, Some(top));
        root
    }

    /// The triangle of all rows.
    pub fn root(&mut self) -> Triangle {
        for level in 1..self.levels.len() {
            for node in 0..self.levels[level].len() {
                if self.levels[level][node].stale {
                    let below = &self.levels[level - 1];
                    let pair = [2 * node, 2 * node + 1].map(|child| below.get(child).and_then(|c| c.top.clone()));
                    let top = match pair {
                        [Some(mut upper), Some(lower)] => {
                            self.fold.both(&mut upper, &lower);
                            Some(upper)
                        }
                        [one, other] => one.or(other),
                    };
                    self.levels[level][node] = Node { top, stale: false };
                }
            }
        }
        let top = self.levels.last().and_then(|level| level.first()).and_then(|node| node.top.clone());
        top.map_or_else(|| Triangle::new(self.unknowns), |top| Triangle::of_entries(self.unknowns, top))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::{BLOCK_ROWS, RowBlock, RowSink};
    use proptest::prelude::*;

    const UNKNOWNS: usize = 5;

    fn row(seed: usize) -> Vec<f64> {
        (0..=UNKNOWNS).map(|k| ((seed * 31 + k * 7) as f64 * 0.618).sin() * 10f64.powi(k as i32 - 2)).collect()
    }

    fn triangle(rows: &[usize]) -> Triangle {
        let mut triangle = Triangle::new(UNKNOWNS);
        for some in rows.chunks(BLOCK_ROWS) {
            let rows: Vec<Vec<f64>> = some.iter().map(|&seed| row(seed)).collect();
            triangle.fold(&mut RowBlock::of_rows(&rows, UNKNOWNS));
        }
        triangle
    }

    /// `RᵀR`, whose entries do not depend on the signs of R's rows, in units of the columns' norms.
    fn normal(triangle: &Triangle) -> Vec<f64> {
        let side = UNKNOWNS + 1;
        let entry = |k: usize| -> f64 { (0..side).map(|i| triangle.at(i, k / side) * triangle.at(i, k % side)).sum() };
        (0..side * side).map(|k| entry(k) / 10f64.powi((k / side + k % side) as i32 - 4)).collect()
    }

    proptest! {
        /// After any rows have come, changed and gone, the root is the triangle of those that are there.
        #[test]
        fn the_root_is_the_triangle_of_what_is_there(acts in prop::collection::vec((0usize..13, 0usize..9, any::<bool>()), 1..60)) {
            let mut tree = TriangleTree::new(UNKNOWNS);
            let mut there: Vec<Vec<usize>> = vec![vec![]; 13];
            for (number, (leaf, count, look)) in acts.into_iter().enumerate() {
                there[leaf] = (0..count).map(|k| number * 10 + k).collect();
                let rows = (count > 0).then(|| triangle(&there[leaf]));
                tree.put(leaf, rows.as_ref());
                if look {
                    let mut others = there.clone();
                    others[leaf].clear();
                    for (root, rows) in [(tree.root_without(leaf), &others), (tree.root(), &there)] {
                        let (found, expected) = (normal(&root), normal(&triangle(&rows.concat())));
                        let size = expected.iter().fold(1e-3f64, |most, value| most.max(value.abs()));
                        for (a, b) in found.iter().zip(&expected) {
                            prop_assert!((a - b).abs() < 1e-13 * size, "{a} {b}");
                        }
                    }
                }
            }
        }
    }

    /// Few rows in very many unknowns: what rounding leaves of them goes through all pivots.
    #[test]
    fn few_rows_of_many_unknowns_keep_their_digits() {
        let unknowns = 60;
        let of =
            |seed: usize| (0..=unknowns).map(|k| ((seed * 97 + k * 13) as f64 * 0.618).sin()).collect::<Vec<f64>>();
        let mut tree = TriangleTree::new(unknowns);
        for leaf in 0..3 {
            let mut rows = Triangle::new(unknowns);
            rows.fold(&mut RowBlock::of_rows(&[of(leaf)], unknowns));
            tree.put(leaf, Some(&rows));
        }
        let root = tree.root();
        for k in 0..=unknowns {
            let found: f64 = (0..=unknowns).map(|i| root.at(i, k).powi(2)).sum();
            let expected: f64 = (0..3).map(|seed| of(seed)[k].powi(2)).sum();
            assert!((found - expected).abs() < 1e-13, "{k}: {found} {expected}");
        }
    }

    #[test]
    fn without_rows_the_root_is_zero() {
        let mut tree = TriangleTree::new(UNKNOWNS);
        assert!(normal(&tree.root()).iter().all(|&value| value == 0.0));
        tree.put(3, Some(&triangle(&[1, 2])));
        tree.put(3, None);
        assert_eq!(tree.leaves(), 4);
        assert!(normal(&tree.root()).iter().all(|&value| value == 0.0));
    }
}
