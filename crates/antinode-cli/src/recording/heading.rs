//! Whether the first line of a text recording holds names or samples.

use super::forms::are_alike;
use super::no_number::stand_in;
use super::number::{self, number};

/// Fewest rows that can tell whether the fields above them are a sample of the same wave.
const MIN_ROWS: usize = 8;
/// Largest distance of a first sample from the wave that follows, in rms residuals.
const MAX_DISTANCE: f64 = 5.0;

/// Whether the fields of the first line are the names of columns, judged by the rows that follow; in doubt they are not, lest a sample
/// be lost.
pub(super) fn is_header(names: &[&[u8]], rows: &[&[&[u8]]], separator: u8) -> bool {
    let is_number = |field: &[u8]| number::is_number(field, separator);
    if !names.iter().any(|name| is_number(name)) {
        // A recording may begin with samples out of range, and a field written like the sample below it is no name.
        let is_sample = |(place, name): (usize, &&[u8])| {
            let below = rows.first().and_then(|row| row.get(place));
            below.is_some_and(|below| !is_number(below) && are_alike(name, below))
        };
        return !names.iter().all(|name| stand_in(name).is_some())
            && !names.iter().enumerate().any(is_sample);
    }
    let is_above_numbers = |place: usize| {
        let mut below = rows.iter().filter_map(|row| row.get(place));
        below.any(|field| is_number(field))
    };
    let mut words = names
        .iter()
        .enumerate()
        .filter(|(_, name)| begins_with_letter(name) && !is_number(name));
    let are_whole = names
        .iter()
        .all(|name| !is_number(name) || name.iter().all(u8::is_ascii_digit));
    are_whole && words.any(|(place, _)| is_above_numbers(place))
        || are_counted(names)
            && are_written_otherwise(names, rows, separator)
            && !is_continued(names, rows, separator)
}

/// Whether a field begins with a letter, as names do, and does not stand for a missing number.
fn begins_with_letter(field: &[u8]) -> bool {
    let text = String::from_utf8_lossy(field);
    stand_in(field).is_none() && text.starts_with(char::is_alphabetic)
}

/// Whether the names are 0, 1 and so on, as written above a table without names; the first may be empty, above the line numbers.
fn are_counted(names: &[&[u8]]) -> bool {
    let counted = match names {
        [b"", rest @ ..] => rest,
        all => all,
    };
    let is_next = |(place, name): (usize, &&[u8])| **name == *place.to_string().as_bytes();
    counted.len() >= 2 && counted.iter().enumerate().all(is_next)
}

/// Whether the numbers below these names all have a decimal mark or an exponent, which 0, 1 and so on lack.
fn are_written_otherwise(names: &[&[u8]], rows: &[&[&[u8]]], separator: u8) -> bool {
    let is_otherwise = |field: &[u8]| {
        number::is_number(field, separator) && field.iter().any(|byte| b".,eE".contains(byte))
    };
    let mut named = (0..names.len()).filter(|&place| !names[place].is_empty());
    named.all(|place| {
        let below = || rows.iter().filter_map(|row| row.get(place));
        below().any(|field| is_otherwise(field))
            && below().all(|field| is_otherwise(field) || stand_in(field).is_some())
    })
}

/// Whether the last two columns continue the first fields as a wave does: in a wave, the sum of a sample's two neighbours is proportional
/// to the sample, both less their means.
fn is_continued(names: &[&[u8]], rows: &[&[&[u8]]], separator: u8) -> bool {
    let pair = |row: &[&[u8]]| {
        let [.., c, d] = row else { return None };
        let pair = [number::<f64>(c, separator)?, number::<f64>(d, separator)?];
        pair.iter().all(|value| value.is_finite()).then_some(pair)
    };
    let Some(first) = pair(names) else {
        return false;
    };
    let pairs: Vec<[f64; 2]> = rows.iter().map_while(|row| pair(row)).collect();
    if pairs.len() < MIN_ROWS {
        return false;
    }
    let channel = |index: usize| pairs.iter().map(move |pair| pair[index]);
    let channels: [Vec<f64>; 2] = [0, 1].map(|index| channel(index).collect());
    // Means over all samples but the first and the last: of the sample, and of the sum of its neighbours.
    let means = channels.each_ref().map(|x| {
        let inner = &x[1..x.len() - 1];
        let count = inner.len() as f64;
        let sums: f64 = x.windows(3).map(|three| three[0] + three[2]).sum();
        [inner.iter().sum::<f64>() / count, sums / count]
    });
    let points = || {
        channels.iter().zip(&means).flat_map(|(x, [own, sum])| {
            x.windows(3)
                .map(move |three| (three[1] - own, three[0] + three[2] - sum))
        })
    };
    let squares: f64 = points().map(|(x, _)| x * x).sum();
    let slope = points().map(|(x, y)| x * y).sum::<f64>() / squares;
    let residuals: f64 = points().map(|(x, y)| (y - slope * x).powi(2)).sum();
    let rms = (residuals / points().count() as f64).sqrt();
    (0..2).all(|index| {
        let ([own, sum], x) = (means[index], &channels[index]);
        let off = first[index] + x[1] - sum - slope * (x[0] - own);
        off.abs() <= MAX_DISTANCE * rms
    })
}

#[cfg(test)]
mod tests {
    use super::super::text::fields;

    fn is_header(first: &str, next: &str) -> bool {
        let split = |line| fields(line, b',').collect::<Vec<_>>();
        let rows: Vec<_> = next.lines().map(|line| split(line.as_bytes())).collect();
        let rows: Vec<_> = rows.iter().map(Vec::as_slice).collect();
        super::is_header(&split(first.as_bytes()), &rows, b',')
    }

    #[test]
    fn names_are_distinguished_from_samples() {
        for (first, next, expected) in [
            ("c,d", "1,2\n", true),
            ("OVER,OVER", "1,2\n", false),
            ("c:1,d:2", "c:3,d:-4\n", false),
            ("0x1F,0x2A", "0x20,0x7\n", false),
            ("CH1,CH2", "1,2\n", true),
            (",c,d", "0,1,2\n", true),
            ("Time,1,2", "0,1,2\n", true),
            ("x-axis,1,2", "second,Volt,Volt\n0,1,2\n", true),
            ("0,1", "0.5,-1e-3\n", true),
            ("0,1", "", false),
            ("0,1", "5,-3\n6,2\n", false),
            ("0,1", "0.5,3\n", false),
            ("1,0", "0.5,0.3\n", false),
            ("0,1,2", "0.0,0.5,0.3\n", true),
            ("0,1,2", "0.0,nan,0.3\n0.1,0.5,0.3\n", true),
            (",0,1", "0,0.5,0.3\n", true),
            ("0.1,x", "0.5,0.3\n", false),
            ("1,x", "0.5,0.3\n", true),
            ("1,x", "", false),
            ("1,1x7", "2,3\n", false),
            ("1,OVER", "2,3\n", false),
            ("2024-05-01,1,2", "2024-05-02,3,4\n", false),
        ] {
            assert_eq!(is_header(first, next), expected, "{first} {next}");
        }
    }

    #[test]
    fn a_wave_that_begins_as_columns_are_counted_is_kept() {
        let wave = |from: usize, scale: f64, noise: f64| -> String {
            (from..16)
                .map(|k| (k, (0.4 * k as f64).sin_cos()))
                .map(|(k, (sin, cos))| {
                    let noise = noise * [0.7, -1.1, 0.2, 1.3, -0.9][k % 5];
                    format!("{:.4},{:.4}\n", scale * sin + noise, scale * cos - noise)
                })
                .collect()
        };
        for noise in [0.0, 0.01] {
            assert!(!is_header("0,1", &wave(1, 1.0, noise)));
            // The same wave, later or of another amplitude.
            assert!(is_header("0,1", &wave(3, 1.0, noise)));
            assert!(is_header("0,1", &wave(1, 0.5, noise)));
        }
    }
}
