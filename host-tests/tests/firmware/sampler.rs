//! The sampler of the boards, with a converter, a ring and a count of triggers that a test can upset.

use std::cell::RefCell;
use std::rc::Rc;

use antinode::Packed;
use antinode_telemetry::Cause;
use firmware::sampler::{Converter, Done, PairClock, Ring, Sampler};
use firmware::sampling::{DUAL_ADC_RAILS, Lapse, Ready, Source};
use firmware::settings::HALF;
use proptest::prelude::*;

/// Triggers that pass while a converter is armed.
const ARMING: u32 = 3;
/// As a count of triggers.
const H: u32 = HALF as u32;

/// The state of converter, ring and count. The pair of a trigger is the number of that trigger.
#[derive(Default)]
struct State {
    triggers: u32,
    is_armed: bool,
    /// The trigger whose pair is not yet in the ring.
    converting: Option<u32>,
    has_overrun: bool,
    is_ring_started: bool,
    /// The ring: pairs written in this round, and all that was written last.
    written: usize,
    memory: Vec<Packed>,
    done: Done,
    /// True if a trigger and its pair come after the next read of the count.
    is_interrupted: bool,
}

impl State {
    fn trigger(&mut self) {
        self.convert();
        self.triggers = self.triggers.wrapping_add(1);
        if self.is_armed && !self.has_overrun {
            self.converting = Some(self.triggers);
        }
    }

    /// The last trigger's pair is written, if it has not been yet.
    fn convert(&mut self) {
        let converted = self.converting.take();
        let Some(number) = converted.filter(|_| self.is_ring_started) else {
            return;
        };
        self.memory[self.written] = Packed(number);
        self.written += 1;
        self.done.first |= self.written == HALF;
        if self.written == 2 * HALF {
            self.done.second = true;
            self.written = 0;
        }
    }
}

/// All three, sharing a state.
#[derive(Clone)]
struct Chip(Rc<RefCell<State>>);

impl Converter for Chip {
    const RATE: () = ();
    const RAILS: [i16; 2] = DUAL_ADC_RAILS;

    fn stop(&mut self) {
        let mut state = self.0.borrow_mut();
        assert!(!state.is_ring_started, "the ring must be stopped before");
        (state.is_armed, state.has_overrun) = (false, false);
        state.converting = None;
    }

    fn arm(&mut self) {
        let mut state = self.0.borrow_mut();
        assert!(state.is_ring_started, "the ring must be started before");
        assert!(!state.is_armed, "the converter must be stopped before");
        (0..ARMING).for_each(|_| state.trigger());
        state.is_armed = true;
    }

    fn has_overrun(&self) -> bool {
        self.0.borrow().has_overrun
    }

    fn is_at_rail(_: Packed) -> bool {
        false
    }
}

impl Ring for Chip {
    fn stop(&mut self) {
        self.0.borrow_mut().is_ring_started = false;
    }

    fn start(&mut self) {
        let mut state = self.0.borrow_mut();
        assert!(!state.is_ring_started, "it must be stopped");
        state.is_ring_started = true;
        (state.written, state.done) = (0, Done::default());
    }

    fn done(&self) -> Done {
        std::mem::take(&mut self.0.borrow_mut().done)
    }

    fn left(&self) -> u32 {
        (2 * HALF - self.0.borrow().written) as u32
    }

    fn half(&self, second: bool) -> &[Packed] {
        let begin = usize::from(second) * HALF;
        // A copy, never freed: the memory itself goes on changing.
        self.0.borrow().memory[begin..][..HALF].to_vec().leak()
    }
}

impl PairClock for Chip {
    fn now(&self) -> u32 {
        let mut state = self.0.borrow_mut();
        let now = state.triggers;
        if std::mem::take(&mut state.is_interrupted) {
            state.trigger();
            state.convert();
        }
        now
    }
}

/// A sampler under test, and the number of the trigger whose pair must be the next handed out.
struct Bench {
    chip: Chip,
    sampler: Sampler<Chip, Chip, Chip>,
    next: u32,
}

impl Bench {
    /// A sampler that begins after this count of triggers.
    fn new(triggers: u32) -> Self {
        let chip = Chip(Rc::new(RefCell::new(State {
            triggers,
            memory: vec![Packed(0); 2 * HALF],
            ..State::default()
        })));
        let sampler = Sampler::new(chip.clone(), chip.clone(), chip.clone());
        Self {
            chip,
            sampler,
            next: triggers.wrapping_add(ARMING + 1),
        }
    }

    /// Lets `count` triggers come, each with its pair.
    fn pass(&self, count: usize) {
        let mut state = self.chip.0.borrow_mut();
        (0..count).for_each(|_| state.trigger());
        state.convert();
    }

    fn upset(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.chip.0.borrow_mut());
    }

    /// Serves the interrupt; the pairs announced must be the next, if none comes round while they are read, for `reading` triggers.
    fn serve(&mut self, reading: usize) -> Ready {
        let ready = self.sampler.next();
        match ready {
            Ready::Nothing => {}
            Ready::Lapse(lapse) => self.skip(lapse),
            Ready::Pairs => {
                self.pass(reading);
                let begin = self.next;
                self.next = begin.wrapping_add(H);
                if self.sampler.is_intact() {
                    let due = (0..H).map(|i| Packed(begin.wrapping_add(i)));
                    assert!(self.sampler.pairs().iter().copied().eq(due));
                } else {
                    let lapse = self.sampler.restart(Cause::Overrun);
                    self.skip(lapse);
                }
            }
        }
        ready
    }

    fn skip(&mut self, lapse: Lapse) {
        self.next = self.next.wrapping_add(lapse.lost);
    }

    /// The cause of the lapse that the interrupt reports, and how many pairs it lost.
    fn lapse(&mut self) -> (Cause, u32) {
        match self.serve(0) {
            Ready::Lapse(lapse) => (lapse.cause, lapse.lost),
            other => panic!("{other:?}"),
        }
    }

    /// True if the next three halves come without a lapse.
    fn is_well(&mut self) -> bool {
        (0..3).all(|_| {
            let written = self.chip.0.borrow().written;
            self.pass(HALF - written % HALF);
            self.serve(0) == Ready::Pairs
        })
    }
}

#[test]
fn halves_are_handed_out_in_turn_across_the_counts_end() {
    let mut bench = Bench::new(u32::MAX - 5 * H);
    for _ in 0..10 {
        bench.pass(HALF - 1);
        assert_eq!(bench.serve(0), Ready::Nothing);
        bench.pass(1);
        assert_eq!(bench.serve(0), Ready::Pairs);
    }
}

#[test]
fn a_late_interrupt_costs_nothing_while_the_other_half_has_room() {
    let mut bench = Bench::new(0);
    bench.pass(HALF);
    bench.pass(HALF - 1);
    assert_eq!(bench.serve(1), Ready::Pairs);
    assert_eq!(bench.serve(0), Ready::Pairs);
    // With one more both are full, whichever was the first.
    for earlier in [0, 1] {
        let mut bench = Bench::new(0);
        for _ in 0..earlier {
            bench.pass(HALF);
            assert_eq!(bench.serve(0), Ready::Pairs);
        }
        bench.pass(2 * HALF);
        assert_eq!(bench.lapse(), (Cause::Overrun, 2 * H + ARMING));
        assert!(bench.is_well());
    }
}

#[test]
fn a_half_that_comes_twice_is_a_gap() {
    let mut bench = Bench::new(0);
    assert!(bench.is_well());
    bench.pass(HALF);
    bench.upset(|state| state.done.second = false);
    bench.pass(HALF);
    assert_eq!(bench.lapse(), (Cause::Overrun, 2 * H + ARMING));
    assert!(bench.is_well());
}

#[test]
fn pairs_overwritten_while_they_are_read_are_not_intact() {
    for (reading, is_intact) in [(HALF - 1, true), (HALF, true), (HALF + 1, false)] {
        let mut bench = Bench::new(0);
        bench.pass(HALF);
        assert_eq!(bench.sampler.next(), Ready::Pairs);
        bench.pass(reading);
        assert_eq!(bench.sampler.is_intact(), is_intact, "{reading}");
    }
}

#[test]
fn a_gap_of_two_pairs_without_a_flag_is_seen_at_the_end_of_its_half() {
    for missing in [2, 3, H, 2 * H] {
        let mut bench = Bench::new(0);
        assert!(bench.is_well());
        bench.pass(50);
        bench.upset(|state| state.triggers += missing);
        bench.pass(HALF - 50);
        assert_eq!(bench.lapse(), (Cause::Overrun, H + missing + ARMING));
        assert!(bench.is_well());
    }
}

#[test]
fn a_pair_without_a_trigger_is_seen() {
    let mut bench = Bench::new(0);
    bench.pass(50);
    bench.upset(|state| state.triggers -= 1);
    bench.pass(HALF - 50);
    assert_eq!(bench.lapse(), (Cause::Overrun, H - 1 + ARMING));
    assert!(bench.is_well());
}

#[test]
fn a_trigger_between_the_reads_of_both_counts_is_no_gap() {
    let mut bench = Bench::new(0);
    for _ in 0..4 {
        let written = bench.chip.0.borrow().written;
        bench.pass(HALF - written % HALF);
        bench.upset(|state| state.is_interrupted = true);
        assert_eq!(bench.serve(0), Ready::Pairs);
    }
}

#[test]
fn a_conversion_that_has_not_ended_is_no_gap() {
    let mut bench = Bench::new(0);
    bench.pass(HALF);
    bench.upset(State::trigger);
    assert_eq!(bench.serve(0), Ready::Pairs);
}

#[test]
fn an_overrun_is_reported_and_sampling_goes_on() {
    let mut bench = Bench::new(0);
    bench.pass(HALF + 10);
    assert_eq!(bench.serve(0), Ready::Pairs);
    bench.upset(|state| state.has_overrun = true);
    bench.pass(7);
    assert_eq!(bench.lapse(), (Cause::Overrun, 17 + ARMING));
    assert!(bench.is_well());
}

#[test]
fn a_failed_transfer_is_reported_even_with_a_full_half() {
    let mut bench = Bench::new(0);
    bench.pass(HALF);
    bench.upset(|state| state.done.error = true);
    assert_eq!(bench.lapse(), (Cause::Dma, H + ARMING));
    assert!(bench.is_well());
}

#[test]
fn a_stalled_converter_is_restarted_with_its_true_cause() {
    for (has_overrun, cause) in [(false, Cause::Converter), (true, Cause::Overrun)] {
        let mut bench = Bench::new(0);
        assert!(bench.is_well());
        // Neither pairs nor interrupts come any more, as with the SPI after an overrun.
        bench.upset(|state| (state.is_armed, state.has_overrun) = (false, has_overrun));
        bench.pass(1000);
        let lost = 1000 + ARMING;
        let lapse = bench.sampler.restart(Cause::Converter);
        assert_eq!(lapse, Lapse { cause, lost });
        bench.skip(lapse);
        assert!(bench.is_well());
    }
}

/// What happens to a sampler.
#[derive(Debug, Clone)]
enum Event {
    Pass(usize),
    Convert,
    Gap(u32),
    Overrun,
    Error,
    Interrupted,
    Serve(usize),
    Restart,
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        6 => (1..3 * HALF).prop_map(Event::Pass),
        6 => (0..2 * HALF).prop_map(Event::Serve),
        2 => Just(Event::Convert),
        1 => (2..5 * H).prop_map(Event::Gap),
        1 => Just(Event::Overrun),
        1 => Just(Event::Error),
        1 => Just(Event::Interrupted),
        1 => Just(Event::Restart),
    ]
}

proptest! {
    /// Whatever happens, pairs handed out are those due, lapses count what is missing, and sampling goes on.
    #[test]
    fn no_pair_is_handed_out_at_another_time_than_its_own(
        start: u32,
        events in prop::collection::vec(event(), 1..60),
    ) {
        let mut bench = Bench::new(start);
        for event in events {
            match event {
                Event::Pass(count) => bench.pass(count),
                Event::Convert => bench.upset(State::trigger),
                Event::Gap(missing) => bench.upset(|state| {
                    state.convert();
                    state.triggers = state.triggers.wrapping_add(missing);
                }),
                Event::Overrun => bench.upset(|state| state.has_overrun = true),
                Event::Error => bench.upset(|state| state.done.error = true),
                Event::Interrupted => bench.upset(|state| state.is_interrupted = true),
                Event::Serve(reading) => {
                    bench.serve(reading);
                }
                Event::Restart => {
                    let lapse = bench.sampler.restart(Cause::Converter);
                    bench.skip(lapse);
                }
            }
        }
        bench.pass(2 * HALF);
        bench.serve(0);
        bench.pass(2 * HALF);
        bench.serve(0);
        prop_assert!(bench.is_well());
    }
}
