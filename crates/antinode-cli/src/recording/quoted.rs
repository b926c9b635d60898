//! Numbers in quotes with a decimal comma, between commas: `"0,498","0,042"`. Outside of quotes commas become semicolons, byte for byte.

use super::number::number;
use super::text::separator;

/// Replaces the commas between fields by semicolons.
pub(super) fn separate(text: &mut [u8]) {
    let mut is_inside = false;
    for byte in text {
        match *byte {
            b'"' => is_inside = !is_inside,
            // A stray quote must not reach into the lines that follow.
            b'\n' => is_inside = false,
            b',' if !is_inside => *byte = b';',
            _ => {}
        }
    }
}

/// Whether numbers in quotes surely have decimal commas: numbers with commas between thousands are quoted too.
pub(super) fn has_decimal_commas(text: &[u8]) -> bool {
    let lines = text.split(|&byte| byte == b'\n');
    let mut lines = lines.filter(|line| separator(line) == b',');
    lines.any(|line| {
        let parts: Vec<&[u8]> = line.split(|&byte| byte == b'"').collect();
        // What follows an unpaired quote is not in quotes.
        let inside = (1..parts.len() - 1).step_by(2);
        inside.map(|place| parts[place]).any(is_decimal)
    })
}

/// Whether this is a number with a comma that does not separate thousands.
fn is_decimal(field: &[u8]) -> bool {
    let mut parts = field.splitn(2, |&byte| byte == b',');
    let (whole, decimals) = (parts.next().unwrap_or_default(), parts.next());
    let is_thousands = |decimals: &[u8]| {
        let is_zero = whole.iter().find(|byte| byte.is_ascii_digit()) == Some(&b'0');
        decimals.len() == 3 && decimals.iter().all(u8::is_ascii_digit) && !is_zero
    };
    number::<f64>(field, b';').is_some() && decimals.is_some_and(|decimals| !is_thousands(decimals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_commas_are_distinguished_from_those_between_thousands() {
        for (text, expected) in [
            ("\"0,498\",\"-1,234\"\n", true),
            ("1,\"-12,34\",\"1,234\"", true),
            ("c,d\n\"1,5e3\",\"7\"", true),
            ("\"1,234\",\"-2,047\"", false),
            ("\"1,234,567\",\"-2,047.5\"", false),
            ("\"0.498\",\"0.042\"", false),
            ("\"0,498\";0,042", false),
            ("0,498,0,042", false),
            ("c,\"U, V\"", false),
            ("1,\"0,5", false),
            ("", false),
        ] {
            assert_eq!(has_decimal_commas(text.as_bytes()), expected, "{text}");
        }
    }

    #[test]
    fn commas_outside_of_quotes_become_semicolons() {
        let mut text = b"t,\"c\",d\n1,\"0,5\",\"0,3\"\n2,\"0,5,3\n4,5".to_vec();
        let expected = b"t;\"c\";d\n1;\"0,5\";\"0,3\"\n2;\"0,5,3\n4;5";
        for _ in 0..2 {
            separate(&mut text);
            assert_eq!(text, expected);
        }
    }
}
