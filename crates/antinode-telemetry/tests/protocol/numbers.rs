//! What the numbers of reports tell.

use antinode::Settings;
use antinode_telemetry::{
    Cause, Configuration, FrontEnd, Hello, Numbers, Place, Report, ReportFrame, State,
};

/// The places of reports with these numbers, one after another.
fn places(reports: &[(u16, Report)]) -> Vec<Place> {
    let mut numbers = Numbers::new();
    let place = |(number, report): &(u16, Report)| {
        numbers.take(&ReportFrame {
            number: *number,
            report: report.clone(),
        })
    };
    reports.iter().map(place).collect()
}

fn hello() -> Report {
    let configuration = Configuration::new(Settings::new(1e5), FrontEnd::DualAdc);
    Report::Hello(Hello::new("0.1.0", configuration))
}

const SEARCHING: Report = Report::State(State::Searching);
const STARTED: Report = Report::State(State::Started(Cause::Watchdog));

#[test]
fn a_hello_whose_number_begins_anew_is_no_start() {
    let reports = [
        (65_534, SEARCHING),
        (65_535, SEARCHING),
        (0, hello()),
        (1, SEARCHING),
    ];
    assert_eq!(places(&reports), [Place::Next(0); 4]);
    // One that comes too early is.
    let reports = [(65_534, SEARCHING), (0, hello())];
    assert_eq!(places(&reports), [Place::Next(0), Place::Start(0)]);
}

#[test]
fn behind_a_start_without_its_hello_no_number_expected_before_is_believed() {
    // Report 5 was expected before the start; now 2 is, and 2 to 4 are missing.
    let reports = [(4, SEARCHING), (1, STARTED), (5, SEARCHING)];
    assert_eq!(
        places(&reports),
        [Place::Next(0), Place::Start(1), Place::Next(3)]
    );
}
