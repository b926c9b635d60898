//! Flaws at a place in the recording, as fields between colons on the command line.

use std::str::FromStr;

use antinode_sim::{Channel, ClipSpan, Dropout, DropoutKind, Loss};

/// A value written as fields between colons.
#[derive(Debug, Clone, Copy)]
pub struct Parsed<T>(pub T);

/// The fields of a value, at least as many as named.
fn fields<'a>(
    text: &'a str,
    form: &str,
    example: &str,
    least: usize,
    most: usize,
) -> Result<Vec<&'a str>, String> {
    let fields: Vec<&str> = text.split(':').collect();
    if (least..=most).contains(&fields.len()) {
        Ok(fields)
    } else {
        Err(format!("it must be {form}, as {example}"))
    }
}

fn number<T: FromStr>(text: &str) -> Result<T, String> {
    text.parse()
        .map_err(|_| format!("“{text}” is not a number"))
}

impl FromStr for Parsed<ClipSpan> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let f = fields(text, "FROM:TO:LEVEL", "0.2:0.3:0.4", 3, 3)?;
        Ok(Self(ClipSpan {
            from: number(f[0])?,
            to: number(f[1])?,
            level: number(f[2])?,
        }))
    }
}

impl FromStr for Parsed<Loss> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let f = fields(text, "INDEX:COUNT", "500000:3", 2, 2)?;
        Ok(Self(Loss {
            at: number(f[0])?,
            count: number(f[1])?,
        }))
    }
}

impl FromStr for Parsed<Dropout> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let f = fields(
            text,
            "FROM:TO:KIND or FROM:TO:KIND:CHANNEL",
            "0.2:0.3:hold",
            3,
            4,
        )?;
        let kind = match f[2] {
            "zero" => DropoutKind::Zero,
            "hold" => DropoutKind::Hold,
            "noise" => DropoutKind::NoiseOnly,
            other => {
                return Err(format!(
                    "“{other}” is no kind of dropout: zero, hold or noise"
                ));
            }
        };
        let channel = match f.get(3).copied() {
            None => None,
            Some("c" | "C") => Some(Channel::C),
            Some("d" | "D") => Some(Channel::D),
            Some(other) => return Err(format!("“{other}” is no channel: c or d")),
        };
        Ok(Self(Dropout {
            from: number(f[0])?,
            to: number(f[1])?,
            kind,
            channel,
        }))
    }
}
