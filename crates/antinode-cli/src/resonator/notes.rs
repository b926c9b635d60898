//! What the numbers of a resonator leave open, in words.

use std::f64::consts::PI;
use std::io::{self, Write};

use antinode_ringdown::resonator::{ByEnergy, DECAY_SEEN, Damping, Found, Frequency, Resonance};
use antinode_ringdown::{BEYOND_NOISE, Run, turn};

use super::Results;
use crate::digits::counted;
use crate::median::ends;
use crate::runs::{rows_in, warn_of_driven};

/// Runs without a decay that are named, at most.
const MAX_NAMED: usize = 5;
/// Turn of a pattern within a run, rad, beyond which flaws of the pick-offs look like splits.
const TURNS: f64 = PI / 8.0;
/// Difference of runs' frequencies, as a share of them, beyond which these are hardly of one resonator: one of fused silica takes 50 K for
/// it.
const MAX_APART: f64 = 5e-3;
/// Runs at rest from which on these determine the splits whatever the flaws.
const ENOUGH_STILL: usize = 2;

/// Writes what the numbers leave open.
pub fn write_notes(out: &mut impl Write, results: &Results) -> io::Result<()> {
    let Resonance {
        driven,
        found,
        frequency,
        ..
    } = &results.resonance;
    warn_of_driven(out, driven)?;
    note_runs(out, results)?;
    note_splits(out, results)?;
    note_others(out, frequency)?;
    note_frequency(out, frequency)?;
    note_damping(out, found)?;
    if found.is_unsteady() {
        writeln!(
            out,
            "no steady rotation explains the rows: pattern angles are taken from the rows, and their drift is not used to find the splits"
        )?;
    }
    note_misfit(out, found)
}

/// Writes which runs are not listed, and which do not decay.
fn note_runs(out: &mut impl Write, results: &Results) -> io::Result<()> {
    let Results {
        rows,
        resonance,
        listed,
    } = results;
    rows.write_notes(&resonance.runs, out)?;
    let others = resonance.runs.len() - listed.len();
    if others > 0 {
        let of_listed: usize = results.listed().map(|run| run.rows.len()).sum();
        writeln!(
            out,
            "not listed: {} with {} rows, too short or too noisy to show a decay alone; the resonator's values include them",
            counted(others as u64, "run"),
            rows_in(&resonance.runs) - of_listed
        )?;
    }
    let (mut growing, mut steady) = (Vec::new(), Vec::new());
    for (index, &run) in listed.iter().enumerate() {
        let (decay, std) = resonance.found.decay_of_run(run);
        if decay < -DECAY_SEEN * std {
            growing.push(index + 1);
        } else if decay < DECAY_SEEN * std {
            steady.push(index + 1);
        }
    }
    warn_of_runs(
        out,
        &growing,
        ["grows: something drives it", "grow: something drives them"],
    )?;
    warn_of_runs(
        out,
        &steady,
        [
            "does not decay significantly: record longer, or check that nothing drives it",
            "do not decay significantly: record longer, or check that nothing drives them",
        ],
    )
}

/// Warns of runs, by their numbers in the list, that have no decay, in words for one and for several.
fn warn_of_runs(out: &mut impl Write, runs: &[usize], [one, several]: [&str; 2]) -> io::Result<()> {
    match runs {
        [] => Ok(()),
        [run] => writeln!(
            out,
            "warning: the wave of run {run} {one}; its decay time and quality factor mean nothing"
        ),
        _ => {
            let named = runs.iter().take(MAX_NAMED).map(usize::to_string);
            let named = named.collect::<Vec<_>>().join(", ");
            let more = match runs.len().saturating_sub(MAX_NAMED) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            writeln!(
                out,
                "warning: the waves of runs {named}{more} {several}; their decay times and quality factors mean nothing"
            )
        }
    }
}

/// Writes if the splits are not determined, or if flaws of the pick-offs look like them.
fn note_splits(out: &mut impl Write, results: &Results) -> io::Result<()> {
    if results.resonance.found.resonator().is_none() {
        writeln!(
            out,
            "the rows do not determine the splits of damping and frequency: give ring-downs at pattern angles of 0°, 22.5° and 45°, or of a \
             pattern that turns by 45° or more; the mean frequency is the one along the patterns, which a split shifts"
        )?;
    } else if let Some(rate) = one_way(results) {
        let (frequency, _) = results.resonance.frequency.mean;
        writeln!(
            out,
            "warning: the pattern turns only one way, and remaining flaws of the pick-offs then look like splits: a gain ratio that is 0.1 % \
             off like {:.1e} 1/s of damping, a skew 10 ns off like {:.1e} Hz; give rows of a pattern that turns the other way too",
            4e-3 * rate,
            4e-8 * rate * frequency
        )?;
    } else if is_one_pattern(&results.resonance)
        && results.resonance.found.damping() == Damping::Steady
    {
        writeln!(
            out,
            "warning: only one pattern that is not turned shows the splits, and damping that changes by 1 % meanwhile looks like a split of \
             damping; give ring-downs at other pattern angles, or of a pattern that turns"
        )?;
    }
    Ok(())
}

/// Rate at which the patterns turn, rad/s, if all that turn do so one way and too few are at rest.
fn one_way(results: &Results) -> Option<f64> {
    let furthest = |run: &Run| {
        let [back, forth] = run.turns();
        [-back, forth].map(|turned| turned > TURNS)
    };
    let (turning, still): (Vec<&Run>, Vec<&Run>) = results
        .listed()
        .partition(|run| furthest(run).contains(&true));
    let ways = furthest(turning.first()?);
    let is_one_way = ways != [true; 2] && turning.iter().all(|run| furthest(run) == ways);
    let turned: f64 = turning.iter().map(|run| run.turned().abs()).sum();
    let seconds: f64 = turning.iter().map(|run| run.seconds()).sum();
    (is_one_way && still.len() < ENOUGH_STILL).then(|| turned / seconds)
}

/// True if all patterns stand where the first one does, and rotation turns none far: the splits are found from how they move it.
fn is_one_pattern(resonance: &Resonance) -> bool {
    let Resonance { runs, found, .. } = resonance;
    let Some(resonator) = found.resonator().filter(|_| !found.is_unsteady()) else {
        return false;
    };
    let first = runs[0].rows[0].angle;
    let mut all = runs.iter().zip(resonator.rotations);
    all.all(|(run, (rotation, _))| {
        let apart = turn(run.rows[0].angle - first);
        apart.abs() < TURNS && (rotation * run.seconds()).abs() < TURNS
    })
}

/// Warns if the frequencies of runs are those of different resonators.
fn note_others(out: &mut impl Write, frequency: &Frequency) -> io::Result<()> {
    let [least, most] = ends(frequency.means.iter().map(|&(mean, _)| mean));
    if most - least > MAX_APART * most {
        writeln!(
            out,
            "warning: the runs' frequencies are up to {:.1} Hz apart: give the rows of one resonator at a time, at temperatures that are alike",
            most - least
        )?;
    }
    Ok(())
}

/// Warns if the frequency moves, and says what is known of the cause.
fn note_frequency(out: &mut impl Write, frequency: &Frequency) -> io::Result<()> {
    if let Some(by_phases) = frequency.contradicted {
        writeln!(
            out,
            "warning: the phases of rows at their times give {by_phases:.3} Hz, which the rows' own frequencies contradict, as if times had \
             been rounded: phases are not used; give the rows with all the digits that `antinode identify` prints"
        )?;
    }
    if let Some(moves) = frequency.moves {
        let with = match frequency.by_energy {
            ByEnergy::Chance => String::new(),
            ByEnergy::Alone(_, drift) => format!(
                "; the dependence on a_A² + a_B² is taken not to be a drift; an unseen drift of {drift:.0e} Hz/s would change it by one \
                 deviation"
            ),
            ByEnergy::Beside(_) => {
                "; the deviation of the dependence on a_A² + a_B² allows for a drift with time".to_owned()
            }
            ByEnergy::Denied => {
                "; the dependence on a_A² + a_B² is not reported: if the shell's stiffness caused it, a_A·a_B would turn the patterns at \
                 another rate than observed"
                    .to_owned()
            }
            ByEnergy::Ambiguous => {
                "; the rows do not distinguish a dependence on a_A² + a_B² from a drift with time: let the wave ring down further".to_owned()
            }
        };
        writeln!(
            out,
            "warning: the frequency varies by {moves:.2e} Hz rms beyond noise: it depends on the amplitude or the temperature, or the sample \
             clock drifts; the deviation of the mean frequency includes this{with}"
        )?;
    }
    Ok(())
}

/// Warns if the damping changes, and says what the numbers then are.
fn note_damping(out: &mut impl Write, found: &Found) -> io::Result<()> {
    let what = match found.damping() {
        Damping::Steady => return Ok(()),
        Damping::ByEnergy => {
            "with the amplitude, or pick-offs or converter are nonlinear: decay times are those of small waves"
        }
        Damping::InTime(0) => {
            return writeln!(
                out,
                "warning: the runs decay at different rates, as at another temperature or pressure, or of another resonator: each has a decay \
                 of its own, and the resonator's is their mean; the differences are allowed for in all other quantities"
            );
        }
        Damping::InTime(_) => {
            "with time, or a gain does, or pick-offs are not calibrated: each run has a decay of its own, that of a straight line through the \
             logarithm of its amplitude"
        }
    };
    writeln!(
        out,
        "warning: the damping changes {what}; the change is allowed for in all other quantities"
    )
}

/// Warns if the rows differ from the resonator's motion by more or less than noise.
fn note_misfit(out: &mut impl Write, found: &Found) -> io::Result<()> {
    let why = "the wave is still driven in some rows (see --from), the damping changes in other ways than are allowed for, a tone at the \
               wave's frequency is always present (as from a drive's feed-through), the pick-offs are not calibrated, a gain or the wave \
               jumped by too little to be flagged, a pick-off or the converter is nonlinear, or the converter's rounding repeats from row \
               to row";
    if found.residual > BEYOND_NOISE {
        writeln!(
            out,
            "warning: rows differ from the resonator's motion by {:.1} times their noise, which --residual FILE shows row by row: {why}; the \
             deviations above include this factor, but the values may be further off",
            found.residual
        )?;
    } else if found.is_below_noise() {
        writeln!(
            out,
            "warning: rows differ from the resonator's motion by only {:.2} times their noise: if noise is below half a converter step, \
             rounding repeats from row to row, and values may be off by several times the deviations above (use more of the converter's \
             range, or add noise before it); or, because of a filter or a second tone, noise is weaker about the wave's frequency than \
             elsewhere, and the deviations are larger than need be (see --coloured and --hum of identify)",
            found.residual
        )?;
    } else if found.is_alike() {
        writeln!(
            out,
            "warning: consecutive rows differ from the resonator's motion in the same way, which noise does not do: {why}; the values may be \
             further off than the deviations above"
        )?;
    }
    if found.withholds_turning() {
        writeln!(
            out,
            "the turning by a_A·a_B is not reported: uncalibrated or nonlinear pick-offs and a gain that drifts have the same effect"
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_without_a_decay_are_named_in_one_line() {
        let told = |runs: &[usize]| {
            let mut told = Vec::new();
            warn_of_runs(&mut told, runs, ["grows", "grow"]).unwrap();
            String::from_utf8(told).unwrap()
        };
        let one = "; its decay time and quality factor mean nothing\n";
        let several = "; their decay times and quality factors mean nothing\n";
        assert_eq!(told(&[]), "");
        assert_eq!(told(&[3]), format!("warning: the wave of run 3 grows{one}"));
        assert_eq!(
            told(&[3, 5]),
            format!("warning: the waves of runs 3, 5 grow{several}")
        );
        assert_eq!(
            told(&[1, 2, 3, 4, 5, 8, 9]),
            format!("warning: the waves of runs 1, 2, 3, 4, 5 and 2 more grow{several}")
        );
    }
}
