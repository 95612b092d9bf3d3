//! Rows of a file sorted by standing of the artefact.

use super::stated::Rows;
use std::collections::HashMap;
use std::ops::Range;

/// Which rows of the file are of which standing.
#[derive(Debug, Clone, Default)]
pub(super) struct Standings {
    /// Rows of the file, standing by standing as they first come, by feature in each.
    pub order: Vec<usize>,
    /// The place of each standing in that order.
    pub each: Vec<Range<usize>>,
}

/// Labels up to so many times the number of rows are looked up in a table.
const DENSE: usize = 4;

impl Standings {
    /// Of all rows; one standing where no placement is told.
    pub fn new(rows: &Rows) -> Standings {
        let numbers = numbers(rows);
        let mut each: Vec<Range<usize>> = Vec::new();
        for &number in &numbers {
            if number as usize == each.len() {
                each.push(0..0);
            }
            each[number as usize].end += 1;
        }
        let mut next = 0;
        for range in &mut each {
            let count = range.end;
            *range = next..next;
            next += count;
        }
        let mut order = vec![0; numbers.len()];
        for (row, &number) in numbers.iter().enumerate() {
            let range = &mut each[number as usize];
            order[range.end] = row;
            range.end += 1;
        }
        if let Some(feature) = rows.feature {
            each.iter().for_each(|range| order[range.clone()].sort_by_key(|&row| feature[row]));
        }
        Standings { order, each }
    }

    /// Those standings for which `first` holds, and the others: with their numbers.
    pub fn split(self, first: impl Fn(&[usize]) -> bool) -> [(Standings, Vec<u32>); 2] {
        let mut parts = [(Standings::default(), vec![]), (Standings::default(), vec![])];
        for (number, range) in self.each.into_iter().enumerate() {
            let rows = &self.order[range];
            let (part, numbers) = &mut parts[usize::from(!first(rows))];
            let begin = part.order.len();
            part.order.extend(rows);
            part.each.push(begin..part.order.len());
            numbers.push(number as u32);
        }
        parts
    }
}

/// The number of each row's standing, counted as they first come.
fn numbers(rows: &Rows) -> Vec<u32> {
    let Some(labels) = rows.placement else {
        return vec![0; rows.probe.len()];
    };
    let mut count = 0;
    let mut number = |known: &mut u32| {
        if *known == u32::MAX {
            *known = count;
            count += 1;
        }
        *known
    };
    let dense = |label: &i64| usize::try_from(*label).is_ok_and(|label| label < DENSE * labels.len());
    if labels.iter().all(dense) {
        let most = labels.iter().max().map_or(0, |&label| label as usize);
        let mut table = vec![u32::MAX; most + 1];
        return labels.iter().map(|&label| number(&mut table[label as usize])).collect();
    }
    let mut table = HashMap::new();
    labels.iter().map(|&label| number(table.entry(label).or_insert(u32::MAX))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(placement: &[i64], feature: &[usize]) -> Standings {
        let probe = vec![0; placement.len()];
        Standings::new(&Rows { placement: Some(placement), feature: Some(feature), probe: &probe, ..Rows::default() })
    }

    #[test]
    fn standings_come_as_they_are_met_and_features_in_order() {
        let labels = [7, 2, 7, 9, 2, 7];
        let feature = [1, 0, 0, 5, 0, 1];
        let sorted = of(&labels, &feature);
        assert_eq!(sorted.order, [2, 0, 5, 1, 4, 3]);
        assert_eq!(sorted.each, [0..3, 3..5, 5..6]);
        // whatever the labels are
        let far = labels.map(|label| label * 1_000_000_007 - 5_000_000_000);
        let same = of(&far, &feature);
        assert_eq!((same.order, same.each), (sorted.order, sorted.each));
    }

    #[test]
    fn parts_keep_their_order_and_numbers() {
        let [(two, of_two), (others, of_others)] =
            of(&[7, 2, 7, 9, 2, 7], &[1, 0, 0, 5, 0, 1]).split(|rows| rows.len() == 2);
        assert_eq!((two.order, of_two), (vec![1, 4], vec![1]));
        assert_eq!((others.order, others.each, of_others), (vec![2, 0, 5, 3], vec![0..3, 3..4], vec![0, 2]));
    }
}
