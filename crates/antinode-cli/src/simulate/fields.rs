//! Parsers of flaws at a place in the recording, given on the command line as fields between colons.

use std::str::FromStr;

use antinode_sim::{Channel, ClipSpan, Dropout, DropoutKind, Loss};

fn number<T: FromStr>(text: &str) -> Result<T, String> {
    text.parse()
        .map_err(|_| format!("“{text}” is not a number"))
}

/// Reads `FROM:TO:LEVEL`.
pub fn clip_span(text: &str) -> Result<ClipSpan, String> {
    let fields: Vec<_> = text.split(':').collect();
    let [from, to, level] = fields[..] else {
        return Err("it must be FROM:TO:LEVEL, as in 0.2:0.3:0.4".to_owned());
    };
    Ok(ClipSpan {
        from: number(from)?,
        to: number(to)?,
        level: number(level)?,
    })
}

/// Reads `INDEX:COUNT`.
pub fn loss(text: &str) -> Result<Loss, String> {
    let fields: Vec<_> = text.split(':').collect();
    let [at, count] = fields[..] else {
        return Err("it must be INDEX:COUNT, as in 500000:3".to_owned());
    };
    let (at, count) = (number(at)?, number(count)?);
    if count == 0 {
        return Err("COUNT is 0, but must be 1 or more".to_owned());
    }
    Ok(Loss { at, count })
}

/// Reads `FROM:TO:KIND` or `FROM:TO:KIND:CHANNEL`.
pub fn dropout(text: &str) -> Result<Dropout, String> {
    let fields: Vec<_> = text.split(':').collect();
    let (from, to, kind, channel) = match fields[..] {
        [from, to, kind] => (from, to, kind, None),
        [from, to, kind, channel] => (from, to, kind, Some(channel)),
        _ => {
            return Err(
                "it must be FROM:TO:KIND or FROM:TO:KIND:CHANNEL, as in 0.2:0.3:hold".to_owned(),
            );
        }
    };
    Ok(Dropout {
        kind: match kind {
            "zero" => DropoutKind::Zero,
            "hold" => DropoutKind::Hold,
            "noise" => DropoutKind::NoiseOnly,
            other => {
                return Err(format!(
                    "“{other}” is not a kind of dropout; give zero, hold or noise"
                ));
            }
        },
        channel: match channel {
            None => None,
            Some("c" | "C") => Some(Channel::C),
            Some("d" | "D") => Some(Channel::D),
            Some(other) => return Err(format!("“{other}” is not a channel; give c or d")),
        },
        from: number(from)?,
        to: number(to)?,
    })
}
