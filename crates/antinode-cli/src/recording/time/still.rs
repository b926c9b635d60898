//! Times that do not go up, and times too coarse to tell whether they do.

use super::super::printed::Printed;

/// Fewest lines in which times that each stand twice are no accident.
const MIN_PAIRED: usize = 8;

/// Whether each of `times` stands in two lines, as for a minimum and a maximum; the first or the last may stand alone.
pub(in super::super) fn are_paired(times: &[f64]) -> bool {
    let steps = || times.windows(2).map(|pair| pair[1] - pair[0]);
    let are_turns = |first: usize| {
        let mut steps = steps().enumerate();
        steps.all(|(index, step)| (index % 2 == first) == (step == 0.0) && step >= 0.0)
    };
    times.len() >= MIN_PAIRED && (are_turns(0) || are_turns(1))
}

/// The index of the first of `times` that does not go up, or of the second if all do, and the fault of times that show no rate.
pub(in super::super) fn standstill(times: &[f64], printed: Printed) -> Option<(usize, String)> {
    let standing = times.windows(2).position(|pair| pair[1] <= pair[0]);
    let at = 1 + standing.unwrap_or(0);
    let (&from, &to) = (times.get(at - 1)?, times.get(at)?);
    let usual = (times.last()? - times.first()?) / (times.len() - 1) as f64;
    let fault = if from <= to && usual > 0.0 {
        coarse(printed.step(to), usual)
    } else {
        backwards(from, to, printed)
    };
    Some((at, fault))
}

/// What is wrong with times printed with too few digits.
pub(super) fn coarse(step: f64, usual: f64) -> String {
    format!(
        "times are given to {step:.0e} s only, too coarse for samples {usual:.4e} s apart; print more digits, and keep times in double precision"
    )
}

/// What is wrong if time stands still or runs backwards.
pub(super) fn backwards(from: f64, to: f64, printed: Printed) -> String {
    let [from, to] = [from, to].map(|time| printed.absolute(time));
    format!(
        "time goes from {from} s to {to} s, but must increase, and what follows is not read; sort the lines, cut the recording here, \
         print times with more digits"
    )
}
