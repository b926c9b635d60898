//! Selections from reports, in their order.

use antinode::Estimate;
use antinode_telemetry::{Acknowledgement, Counters, Report};

/// The estimates among reports.
pub fn estimates(reports: &[Report]) -> Vec<Estimate> {
    let found = |report: &Report| match report {
        Report::Estimate(estimate) => Some(*estimate),
        _ => None,
    };
    reports.iter().filter_map(found).collect()
}

/// The counters among reports.
pub fn counters(reports: &[Report]) -> Vec<Counters> {
    let found = |report: &Report| match report {
        Report::Counters(counters) => Some(*counters),
        _ => None,
    };
    reports.iter().filter_map(found).collect()
}

/// The last counters among reports.
pub fn last_counters(reports: &[Report]) -> Counters {
    *counters(reports).last().expect("there are some")
}

/// The acknowledgements among reports.
pub fn acknowledgements(reports: &[Report]) -> Vec<Acknowledgement> {
    let found = |report: &Report| match report {
        Report::Acknowledgement(acknowledgement) => Some(*acknowledgement),
        _ => None,
    };
    reports.iter().filter_map(found).collect()
}
