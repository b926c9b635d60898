//! Spans of samples, followed in step with the stream.

use crate::error::Error;
use crate::time::first_sample_from;

/// Samples from `first` to before `end`, and what happens to them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span<T> {
    pub first: u64,
    pub end: u64,
    pub what: T,
}

impl<T> Span<T> {
    /// The samples whose time is `from` or later and before `to`, both s. `list` names the list for the error.
    pub fn of_times(
        from: f64,
        to: f64,
        sample_rate: f64,
        what: T,
        list: &'static str,
    ) -> Result<Span<T>, Error> {
        if !(from < to && from.is_finite() && to.is_finite()) {
            return Err(Error::EmptySpan {
                what: list,
                from,
                to,
            });
        }
        Ok(Span {
            first: first_sample_from(from, sample_rate),
            end: first_sample_from(to, sample_rate),
            what,
        })
    }
}

/// Refuses spans (in order of `first`) that overlap.
pub(crate) fn check_apart<T>(spans: &[Span<T>], list: &'static str) -> Result<(), Error> {
    for pair in spans.windows(2) {
        if let [a, b] = pair
            && b.first < a.end
        {
            return Err(Error::Overlap {
                what: list,
                index: b.first,
            });
        }
    }
    Ok(())
}

/// Spans in order of time, for look-ups of indices that never decrease.
#[derive(Debug, Clone)]
pub(crate) struct Spans<T> {
    spans: Vec<Span<T>>,
    current: usize,
}

impl<T: Copy> Spans<T> {
    pub fn new(mut spans: Vec<Span<T>>) -> Spans<T> {
        spans.retain(|span| span.first < span.end);
        spans.sort_by_key(|span| span.first);
        Spans { spans, current: 0 }
    }

    /// All of them, in order.
    pub fn all(&self) -> &[Span<T>] {
        &self.spans
    }

    /// The span that contains `index` or, if none does, the next one.
    pub fn from(&mut self, index: u64) -> Option<Span<T>> {
        while self.spans.get(self.current)?.end <= index {
            self.current += 1;
        }
        self.spans.get(self.current).copied()
    }

    /// The span that contains `index`.
    pub fn at(&mut self, index: u64) -> Option<Span<T>> {
        self.from(index).filter(|span| span.first <= index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_index_finds_the_span_that_contains_it() {
        let span = |first, end, what| Span { first, end, what };
        let mut spans = Spans::new(vec![
            span(7, 9, 'b'),
            span(2, 4, 'a'),
            span(9, 10, 'c'),
            span(5, 5, 'x'),
        ]);
        let found: String = (0..12)
            .map(|k| spans.at(k).map_or('.', |s| s.what))
            .collect();
        assert_eq!(found, "..aa...bbc..");
    }

    #[test]
    fn only_shared_samples_are_an_overlap() {
        let span = |first, end| Span {
            first,
            end,
            what: (),
        };
        assert_eq!(check_apart(&[span(0, 5), span(5, 6)], "dropouts"), Ok(()));
        assert_eq!(
            check_apart(&[span(0, 5), span(4, 6)], "dropouts"),
            Err(Error::Overlap {
                what: "dropouts",
                index: 4
            })
        );
    }

    #[test]
    fn times_are_half_open() {
        let span = Span::of_times(0.07, 0.08, 100_000.0, (), "dropouts").unwrap();
        assert_eq!((span.first, span.end), (7000, 8000));
        for (from, to) in [
            (1.0, 1.0),
            (2.0, 1.0),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
        ] {
            assert!(Span::of_times(from, to, 100_000.0, (), "dropouts").is_err());
        }
    }
}
