//! Reduces rows to the points that a figure's width can show: of each column of pixels the first, the least, the greatest and the last.

use std::ops::Range;

/// A value to be drawn, or none.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Time, s.
    pub time: f64,
    /// With one standard deviation, 0 if there is none; `None` if the row has no number, where the line ends.
    pub value: Option<(f64, f64)>,
    /// True if no line leads to it.
    pub begins: bool,
}

/// A line without a break, and the band about it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Piece {
    /// Times and values.
    pub line: Vec<(f64, f64)>,
    /// Times, and the band's edges.
    pub band: Vec<(f64, [f64; 2])>,
}

/// The part of one line in a column of pixels.
struct Column {
    number: usize,
    begins: bool,
    first: (f64, f64),
    least: (f64, f64),
    greatest: (f64, f64),
    last: (f64, f64),
    band: [f64; 2],
}

/// The column of a time, where a span has this many columns.
pub fn column(time: f64, span: &Range<f64>, columns: usize) -> usize {
    let share = (time - span.start) / (span.end - span.start);
    // Beyond either end, `as` saturates.
    ((share * columns as f64) as usize).min(columns - 1)
}

/// Pieces that look the same as all samples when drawn over this many columns.
pub fn reduce(
    samples: impl Iterator<Item = Sample>,
    span: &Range<f64>,
    columns: usize,
) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut current: Option<Column> = None;
    // True after a sample without a number, which ends the line.
    let mut begins = true;
    for sample in samples {
        begins |= sample.begins;
        let Some((value, deviation)) = sample.value else {
            begins = true;
            continue;
        };
        let number = column(sample.time, span, columns);
        let point = (sample.time, value);
        let edges = [value - deviation, value + deviation];
        match &mut current {
            // A break within a column cannot be seen.
            Some(column) if column.number == number => {
                column.last = point;
                if value < column.least.1 {
                    column.least = point;
                }
                if value > column.greatest.1 {
                    column.greatest = point;
                }
                column.band[0] = column.band[0].min(edges[0]);
                column.band[1] = column.band[1].max(edges[1]);
            }
            _ => {
                let new = Column {
                    number,
                    begins,
                    first: point,
                    least: point,
                    greatest: point,
                    last: point,
                    band: edges,
                };
                if let Some(before) = current.replace(new) {
                    before.end(&mut pieces);
                }
            }
        }
        begins = false;
    }
    if let Some(column) = current {
        column.end(&mut pieces);
    }
    pieces
}

impl Column {
    /// Adds the column to the last piece, or to a new one.
    fn end(self, pieces: &mut Vec<Piece>) {
        if self.begins || pieces.is_empty() {
            pieces.push(Piece::default());
        }
        let Some(piece) = pieces.last_mut() else {
            return;
        };
        let (mut one, mut other) = (self.least, self.greatest);
        if one.0 > other.0 {
            std::mem::swap(&mut one, &mut other);
        }
        let mut points = vec![self.first, one, other, self.last];
        points.dedup();
        piece.line.extend(points);
        piece.band.push((self.first.0, self.band));
        if self.last.0 > self.first.0 {
            piece.band.push((self.last.0, self.band));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(time: f64, value: f64) -> Sample {
        Sample {
            time,
            value: Some((value, 0.5)),
            begins: false,
        }
    }

    #[test]
    fn few_rows_stay_as_they_are() {
        let rows = [(0.0, 3.0), (1.0, 2.0), (2.0, 5.0), (4.0, 1.0)];
        let pieces = reduce(rows.iter().map(|&(t, v)| sample(t, v)), &(0.0..4.0), 100);
        assert_eq!(pieces.len(), 1);
        assert_eq!(pieces[0].line, rows);
        assert_eq!(pieces[0].band[2], (2.0, [4.5, 5.5]));
        assert_eq!(pieces[0].band.len(), 4);
    }

    #[test]
    fn a_column_keeps_first_least_greatest_and_last_in_their_order() {
        let values = [2.0, 1.0, 9.0, -7.0, 4.0, 3.0, 8.0, 3.5];
        let rows = (0..8).map(|k| sample(f64::from(k), values[k as usize]));
        let pieces = reduce(rows, &(0.0..8.0), 2);
        let line = [
            (0.0, 2.0),
            (2.0, 9.0),
            (3.0, -7.0),
            (4.0, 4.0),
            (5.0, 3.0),
            (6.0, 8.0),
            (7.0, 3.5),
        ];
        assert_eq!(pieces.len(), 1);
        assert_eq!(pieces[0].line, line);
        let band = [
            (0.0, [-7.5, 9.5]),
            (3.0, [-7.5, 9.5]),
            (4.0, [2.5, 8.5]),
            (7.0, [2.5, 8.5]),
        ];
        assert_eq!(pieces[0].band, band);
    }

    #[test]
    fn many_rows_become_no_more_points_than_columns_show() {
        // A single spike in 10⁶ rows is kept.
        let value = |k: u32| {
            if k == 765_432 {
                100.0
            } else {
                f64::from(k % 7)
            }
        };
        let rows = (0..1_000_000).map(|k| sample(f64::from(k), value(k)));
        let pieces = reduce(rows, &(0.0..1e6), 500);
        assert_eq!(pieces.len(), 1);
        assert!(pieces[0].line.len() <= 4 * 500 && pieces[0].band.len() <= 2 * 500);
        assert!(pieces[0].line.contains(&(765_432.0, 100.0)));
        assert!(pieces[0].line.is_sorted_by(|one, next| one.0 < next.0));
    }

    #[test]
    fn a_line_ends_where_there_is_no_value_and_where_another_begins() {
        let mut rows: Vec<_> = (0..10).map(|k| sample(f64::from(k), 1.0)).collect();
        rows[3].value = None;
        rows[7].begins = true;
        let pieces = reduce(rows.iter().copied(), &(0.0..9.0), 100);
        let times: Vec<Vec<_>> = pieces
            .iter()
            .map(|piece| piece.line.iter().map(|point| point.0).collect())
            .collect();
        assert_eq!(
            times,
            [
                vec![0.0, 1.0, 2.0],
                vec![4.0, 5.0, 6.0],
                vec![7.0, 8.0, 9.0]
            ]
        );
        // A break within a column is not seen, and one at the end of a column is.
        assert_eq!(reduce(rows[..6].iter().copied(), &(0.0..9.0), 1).len(), 1);
        assert_eq!(reduce(rows.iter().copied(), &(3.0..11.0), 2).len(), 2);
        assert!(reduce([].into_iter(), &(0.0..9.0), 5).is_empty());
    }
}
