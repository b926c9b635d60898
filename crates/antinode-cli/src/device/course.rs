//! The course of a device's reports: how many are missing and that it has restarted, by their numbers and times.

use std::mem;

use antinode_telemetry::{Numbers, Place, Report, ReportFrame};

/// Longest hole whose missing reports are counted by their numbers, which are modulo 65 536, s: no device sends as many in it.
const COUNTABLE: f64 = 10.0;

/// Most reports missing that are believed whatever time has passed: more without a time, or in no time, may be a restart.
const BELIEVED: u64 = 1000;

/// The clock of counters, which come each second; the other one is that of estimates, which come only if there is a wave.
const UPTIME: usize = 0;

/// What a report shows of those before it.
#[derive(Debug, PartialEq)]
pub enum Event {
    /// The device has started.
    Started,
    /// So many are missing.
    Lost(u64),
    /// So many are missing, or more by a multiple of 65 536, in this time, s. Without a time the device may have restarted.
    Uncounted(u64, Option<f64>),
    /// The device has restarted, without a report of its start.
    Restarted,
}

/// The course so far. Unlike a [`Receiver`](antinode_telemetry::Receiver) it tells a long hole and a restart by the reports' times.
#[derive(Debug, Default)]
pub struct Course {
    numbers: Numbers,
    /// Times of the last counters and of the last estimate, s, each by its own clock.
    times: [Option<f64>; 2],
    /// Missing reports, until one with a time shows what they are.
    missing: u64,
    /// Reports since the last expected or later one that may have come before.
    doubtful: u64,
    /// What `times` was before the first of these was missing.
    before: Option<[Option<f64>; 2]>,
}

impl Course {
    /// Takes a report; gives what it shows.
    pub fn take(&mut self, frame: &ReportFrame) -> Option<Event> {
        let timed = match &frame.report {
            Report::Counters(counters) => Some((UPTIME, counters.uptime_ms as f64 * 1e-3)),
            Report::Estimate(estimate) => Some((1 - UPTIME, estimate.time)),
            _ => None,
        };
        let missing = match self.numbers.take(frame) {
            Place::Start(missing) => {
                // What is missing since is told later.
                *self = Self {
                    numbers: mem::take(&mut self.numbers),
                    missing: missing.into(),
                    ..Self::default()
                };
                return Some(Event::Started);
            }
            Place::Next(missing) => {
                self.doubtful = 0;
                u64::from(missing)
            }
            Place::Again(back) if timed.is_none_or(|timed| self.is_repeated(timed, back)) => {
                self.doubtful += 1;
                return None;
            }
            // Its time contradicts: it is new after all, and those before it were new too.
            Place::Again(back) => {
                self.numbers.go_on_behind(frame.number);
                u64::from(back.wrapping_neg()).saturating_sub(mem::take(&mut self.doubtful))
            }
        };
        let before = self.before.unwrap_or(self.times);
        if missing > 0 {
            self.missing += missing;
            self.before = Some(before);
        }
        timed.and_then(|timed| self.judge(timed, before))
    }

    /// What is missing, now that a report tells the time; `before` are the times before that.
    fn judge(&mut self, (clock, now): (usize, f64), before: [Option<f64>; 2]) -> Option<Event> {
        let last = self.times[clock].replace(now);
        let passed = before[clock].map(|before| now - before);
        // More than can be sent meanwhile is missing after a restart too.
        let most = |passed: f64| passed * (65_536.0 / COUNTABLE) + BELIEVED as f64;
        if last.is_some_and(|last| now < last)
            || passed.is_some_and(|passed| self.missing as f64 > most(passed))
        {
            *self = Self {
                numbers: mem::take(&mut self.numbers),
                ..Self::default()
            };
            self.times[clock] = Some(now);
            return Some(Event::Restarted);
        }
        let is_counted = passed.map_or(self.missing <= BELIEVED, |passed| passed <= COUNTABLE);
        // The wave may have been lost long before: counters tell better.
        if !is_counted && clock != UPTIME && before[UPTIME].is_some() {
            return None;
        }
        self.before = None;
        match mem::take(&mut self.missing) {
            lost if is_counted => (lost > 0).then_some(Event::Lost(lost)),
            // Without counters there may have been no wave and nothing to report.
            0 if clock != UPTIME => None,
            lost => Some(Event::Uncounted(lost, passed)),
        }
    }

    /// Ends the reports; gives what no later one can show.
    pub fn finish(&mut self) -> Option<Event> {
        match mem::take(&mut self.missing) {
            0 => None,
            lost if lost <= BELIEVED => Some(Event::Lost(lost)),
            lost => Some(Event::Uncounted(lost, None)),
        }
    }

    /// True if a report whose number is so far back has come before: one comes each second or more often.
    fn is_repeated(&self, (clock, now): (usize, f64), back: u16) -> bool {
        let most = f64::from(back) + 2.0;
        self.times[clock].is_none_or(|last| (0.0..=most).contains(&(last - now)))
    }
}

#[cfg(test)]
mod tests {
    use antinode::{Estimate, Identifier, Settings};
    use antinode_telemetry::{Cause, Configuration, Counters, FrontEnd, Hello, State};

    use super::*;

    fn counters(seconds: f64) -> Report {
        Report::Counters(Counters {
            uptime_ms: (seconds * 1e3) as u64,
            ..Counters::default()
        })
    }

    /// An estimate of a wave, at this time.
    fn estimate(time: f64) -> Report {
        let mut identifier = Identifier::<f32, 200, 16>::new(Settings::new(1e5)).unwrap();
        let pair = |k: u32| [(f64::from(k) * 0.335).cos() as f32, 0.0];
        let estimate = (0..2000).find_map(|k| identifier.push(pair(k)));
        Report::Estimate(Estimate {
            time,
            ..estimate.expect("a window")
        })
    }

    fn state() -> Report {
        Report::State(State::Searching)
    }

    fn started() -> Report {
        Report::State(State::Started(Cause::Watchdog))
    }

    /// What reports show, each of which has this number modulo 65 536, and what is left at their end.
    fn events(reports: impl IntoIterator<Item = (u32, Report)>) -> Vec<Event> {
        let mut course = Course::default();
        let mut events = Vec::new();
        for (number, report) in reports {
            let number = number as u16;
            events.extend(course.take(&ReportFrame { number, report }));
        }
        events.extend(course.finish());
        events
    }

    #[test]
    fn holes_of_seconds_are_counted_once_a_time_is_known() {
        let hole = [(9, counters(1.0)), (4010, state()), (4013, counters(9.0))];
        assert_eq!(events(hole), [Event::Lost(4002)]);
        let across = [(65_530, estimate(1.0)), (65_540, estimate(1.1))];
        assert_eq!(events(across), [Event::Lost(9)]);
        // The wave was lost long before: counters show that the hole is short.
        let no_wave = [
            (0, estimate(1.0)),
            (1, counters(1.5)),
            (2, counters(100.5)),
            (4, estimate(101.0)),
            (5, counters(101.5)),
        ];
        let between = Event::Uncounted(0, Some(99.0));
        assert_eq!(events(no_wave), [between, Event::Lost(1)]);
        // Without a time.
        assert_eq!(events([(0, state()), (3, state())]), [Event::Lost(2)]);
        let unknown = events([(0, state()), (3000, counters(1.0))]);
        assert_eq!(unknown, [Event::Uncounted(2999, None)]);
        let unknown = events([(0, state()), (3000, state())]);
        assert_eq!(unknown, [Event::Uncounted(2999, None)]);
    }

    #[test]
    fn longer_holes_are_not_counted_exactly() {
        let hole = |lost: u32, time: fn(f64) -> Report| {
            events([
                (9, time(1.0)),
                (10 + lost, time(125.0)),
                // What follows is counted as ever.
                (13 + lost, time(125.1)),
            ])
        };
        for (lost, told) in [(30_000, 30_000), (65_300, 65_300), (70_000, 4464)] {
            for time in [counters, estimate] {
                let expected = [Event::Uncounted(told, Some(124.0)), Event::Lost(2)];
                assert_eq!(hole(lost, time), expected);
            }
        }
        let expected = [Event::Uncounted(0, Some(124.0)), Event::Lost(2)];
        assert_eq!(hole(65_536, counters), expected);
        // Estimates alone: no wave for a while is no hole.
        assert_eq!(hole(65_536, estimate), [Event::Lost(2)]);
    }

    #[test]
    fn reports_that_come_again_show_nothing() {
        let seen = |i: u32| (65_400 + i, counters(f64::from(i)));
        let order = (0..290).chain([289]).chain(40..290).chain([291]);
        assert_eq!(events(order.map(seen)), [Event::Lost(1)]);
    }

    #[test]
    fn a_time_that_goes_back_is_a_restart_without_losses() {
        for time in [counters, estimate] {
            for number in [2, 40_000, 49_900] {
                let restart = [
                    (50_000, time(300.0)),
                    (number, state()),
                    (number + 1, time(0.1)),
                    (number + 4, time(0.2)),
                ];
                let expected = [Event::Restarted, Event::Lost(2)];
                assert_eq!(events(restart), expected, "{number}");
            }
            // Later than the one before, but the numbers cannot have gone so far.
            let restart = [(100, time(0.1)), (60, time(0.5))];
            assert_eq!(events(restart), [Event::Restarted]);
        }
    }

    #[test]
    fn after_a_start_only_reports_missing_since_then_are_lost() {
        let configuration = Configuration::new(Settings::new(1e5), FrontEnd::Synthetic);
        let hello = Report::Hello(Hello::new("1", configuration));
        let with = [
            (50_000, counters(300.0)),
            (50_010, state()),
            (0, hello),
            (1, started()),
            (2, counters(0.1)),
        ];
        assert_eq!(events(with.clone()), [Event::Started]);
        let [before, hole, _, started, after] = with;
        let without = events([before, hole, started, after]);
        assert_eq!(without, [Event::Started, Event::Lost(1)]);
    }

    #[test]
    fn a_start_that_comes_again_loses_nothing() {
        let configuration = Configuration::new(Settings::new(1e5), FrontEnd::Synthetic);
        let hello = Report::Hello(Hello::new("1", configuration));
        for (numbers, starts, lost) in [
            (&[0, 1, 1, 2, 3][..], 1, 0),
            (&[0, 0, 1, 1, 2, 2, 3], 2, 0),
            (&[0, 1, 2, 0, 0, 3, 5], 3, 1),
            (&[0, 1, 2, 3, 0, 2, 3], 2, 1),
            // Too far back for one that comes again.
            (&[600, 0, 601], 1, 600),
        ] {
            let reports = numbers.iter().map(|&number| match number {
                0 => (0, hello.clone()),
                1 => (1, started()),
                _ => (number, counters(f64::from(number))),
            });
            let mut told = events(reports);
            let all = told.len();
            told.retain(|event| *event != Event::Started);
            assert_eq!(all - told.len(), starts, "{numbers:?}");
            let expected = (lost > 0).then_some(Event::Lost(lost));
            assert!(told.into_iter().eq(expected), "{numbers:?}");
        }
    }
}
