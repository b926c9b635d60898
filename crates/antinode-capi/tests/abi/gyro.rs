//! A state of the C ABI in either arithmetic, behind functions that are safe to call.
#![allow(unsafe_code, reason = "the functions of a C ABI")]

use std::cell::UnsafeCell;
use std::mem::MaybeUninit;

use antinode::{Packed, Sample};
use antinode_capi::*;

/// The functions of one arithmetic.
pub struct Abi<S, State> {
    pub init: unsafe extern "C" fn(*mut State, *const Settings) -> Status,
    pub reset: unsafe extern "C" fn(*mut State) -> Status,
    pub push: unsafe extern "C" fn(*mut State, S, S) -> Status,
    pub separate: unsafe extern "C" fn(*mut State, *const S, *const S, usize) -> Status,
    pub interleaved: unsafe extern "C" fn(*mut State, *const S, usize) -> Status,
    pub packed: unsafe extern "C" fn(*mut State, *const u32, usize) -> Status,
    pub skip: unsafe extern "C" fn(*mut State, u32) -> Status,
    pub solve: unsafe extern "C" fn(*mut State, *mut Estimate) -> Status,
    pub search: unsafe extern "C" fn(*mut State) -> Status,
    pub set_calibration: unsafe extern "C" fn(*mut State, *const Calibration) -> Status,
    pub health: unsafe extern "C" fn(*const State, *mut Health) -> Status,
    pub identify:
        unsafe extern "C" fn(*mut State, *const S, usize, *mut usize, *mut Estimate) -> Status,
}

/// A type of samples that the ABI takes, with its state and its functions.
pub trait Arithmetic: Sample + From<i16> {
    type State;
    const COLD: Self::State;
    const ABI: Abi<Self, Self::State>;
}

impl Arithmetic for i16 {
    type State = Fixed;
    const COLD: Fixed = Fixed::ZERO;
    const ABI: Abi<i16, Fixed> = Abi {
        init: antinode_fixed_init,
        reset: antinode_fixed_reset,
        push: antinode_fixed_push,
        separate: antinode_fixed_push_block,
        interleaved: antinode_fixed_push_block_interleaved,
        packed: antinode_fixed_push_block_packed,
        skip: antinode_fixed_skip,
        solve: antinode_fixed_solve,
        search: antinode_fixed_search,
        set_calibration: antinode_fixed_set_calibration,
        health: antinode_fixed_health,
        identify: antinode_fixed_identify,
    };
}

impl Arithmetic for f32 {
    type State = Float;
    const COLD: Float = Float::ZERO;
    const ABI: Abi<f32, Float> = Abi {
        init: antinode_float_init,
        reset: antinode_float_reset,
        push: antinode_float_push,
        separate: antinode_float_push_block,
        interleaved: antinode_float_push_block_interleaved,
        packed: antinode_float_push_block_packed,
        skip: antinode_float_skip,
        solve: antinode_float_solve,
        search: antinode_float_search,
        set_calibration: antinode_float_set_calibration,
        health: antinode_float_health,
        identify: antinode_float_identify,
    };
}

/// How pairs reach a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way {
    Single,
    Separate,
    Interleaved,
    Packed,
}

impl Way {
    pub const BLOCKS: [Self; 3] = [Self::Separate, Self::Interleaved, Self::Packed];
    pub const ALL: [Self; 4] = [
        Self::Single,
        Self::Separate,
        Self::Interleaved,
        Self::Packed,
    ];
}

/// A value of `reserved` that no function writes: it marks an estimate that was not written.
pub const UNWRITTEN: u32 = 77;

/// A state that only this thread uses.
pub struct Gyro<S: Arithmetic> {
    /// In an `UnsafeCell`, because in C a pointer to const keeps nobody else from writing.
    state: Box<UnsafeCell<S::State>>,
}

// SAFETY, of every call here: the state and whatever is pointed to exist, and `&mut` guarantees that nobody else uses the state.
impl<S: Arithmetic> Gyro<S> {
    /// A state of zeroed memory, not initialised.
    pub fn cold() -> Self {
        Self {
            state: Box::new(UnsafeCell::new(S::COLD)),
        }
    }

    /// A state not initialised, of memory filled with a byte, as a stack may leave it.
    pub fn filled(byte: u8) -> Self {
        let gyro = Self::cold();
        // SAFETY: a state is numbers, whatever they are.
        unsafe { gyro.state.get().write_bytes(byte, 1) };
        gyro
    }

    pub fn new(settings: &Settings) -> Self {
        let mut gyro = Self::cold();
        assert_eq!(gyro.init(Some(settings)), Status::Ok);
        gyro
    }

    /// A copy of the state at another address.
    pub fn copy(&self) -> Self {
        let copy = Self::cold();
        // SAFETY: two states of the same type.
        unsafe { std::ptr::copy_nonoverlapping(self.state.get(), copy.state.get(), 1) };
        copy
    }

    /// The state's address, for calls with bad pointers.
    pub fn pointer(&mut self) -> *mut S::State {
        self.state.get()
    }

    /// Initialises the state, with NULL for `None`.
    pub fn init(&mut self, settings: Option<&Settings>) -> Status {
        let settings = settings.map_or(std::ptr::null(), |settings| &raw const *settings);
        // SAFETY: see above.
        unsafe { (S::ABI.init)(self.state.get(), settings) }
    }

    pub fn reset(&mut self) -> Status {
        // SAFETY: see above.
        unsafe { (S::ABI.reset)(self.state.get()) }
    }

    /// Pushes pairs by one call, or one by one and then returns the gravest status.
    pub fn push(&mut self, way: Way, codes: &[[i16; 2]]) -> Status {
        let state = self.state.get();
        let samples: Vec<[S; 2]> = codes.iter().map(|pair| pair.map(S::from)).collect();
        let part = |part: usize| samples.iter().map(|pair| pair[part]).collect::<Vec<S>>();
        let words: Vec<u32> = codes.iter().map(|&pair| Packed::from(pair).0).collect();
        let count = codes.len();
        // SAFETY: see above.
        unsafe {
            match way {
                Way::Single => samples
                    .iter()
                    .map(|&[c, d]| (S::ABI.push)(state, c, d))
                    .max()
                    .unwrap_or(Status::Ok),
                Way::Separate => {
                    (S::ABI.separate)(state, part(0).as_ptr(), part(1).as_ptr(), count)
                }
                Way::Interleaved => (S::ABI.interleaved)(state, samples.as_ptr().cast(), count),
                Way::Packed => (S::ABI.packed)(state, words.as_ptr(), count),
            }
        }
    }

    pub fn skip(&mut self, count: u32) -> Status {
        // SAFETY: see above.
        unsafe { (S::ABI.skip)(self.state.get(), count) }
    }

    pub fn search(&mut self) -> Status {
        // SAFETY: see above.
        unsafe { (S::ABI.search)(self.state.get()) }
    }

    pub fn set_calibration(&mut self, calibration: Calibration) -> Status {
        // SAFETY: see above.
        unsafe { (S::ABI.set_calibration)(self.state.get(), &calibration) }
    }

    /// Calls `_solve`; returns its status and the estimate after the call.
    pub fn solve(&mut self) -> (Status, Estimate) {
        let mut estimate = unwritten();
        // SAFETY: see above.
        let status = unsafe { (S::ABI.solve)(self.state.get(), &mut estimate) };
        (status, estimate)
    }

    /// Estimates until no block is left.
    pub fn rows(&mut self) -> Vec<Estimate> {
        std::iter::from_fn(|| match self.solve() {
            (Status::Estimate, row) => Some(row),
            (status, _) => {
                assert_eq!(status, Status::Ok);
                None
            }
        })
        .collect()
    }

    /// Pushes pairs in pieces of `step` and solves after each; fails if a block is dropped.
    pub fn run(&mut self, way: Way, step: usize, codes: &[[i16; 2]]) -> Vec<Estimate> {
        let mut all = Vec::new();
        for piece in codes.chunks(step) {
            let status = self.push(way, piece);
            let is_well = matches!(status, Status::Ok | Status::Ready);
            assert!(is_well, "{way:?}, {step} at once: {status:?}");
            all.extend(self.rows());
        }
        all
    }

    pub fn try_health(&self) -> (Status, Health) {
        let mut health = MaybeUninit::zeroed();
        // SAFETY: see above; all zeros are a health.
        unsafe {
            let status = (S::ABI.health)(self.state.get(), health.as_mut_ptr());
            (status, health.assume_init())
        }
    }

    pub fn health(&self) -> Health {
        let (status, health) = self.try_health();
        assert_eq!(status, Status::Ok);
        health
    }

    /// Calls `_identify`; returns its status, the count of pairs that it says it took (all ones if it says nothing), and the estimate.
    pub fn identify(&mut self, codes: &[[i16; 2]]) -> (Status, usize, Estimate) {
        let samples: Vec<[S; 2]> = codes.iter().map(|pair| pair.map(S::from)).collect();
        let (mut taken, mut estimate) = (usize::MAX, unwritten());
        // SAFETY: see above.
        let status = unsafe {
            let first = samples.as_ptr().cast();
            (S::ABI.identify)(
                self.state.get(),
                first,
                samples.len(),
                &mut taken,
                &mut estimate,
            )
        };
        (status, taken, estimate)
    }
}

/// An estimate that no function has written to.
pub fn unwritten() -> Estimate {
    // SAFETY: numbers only.
    let mut estimate: Estimate = unsafe { MaybeUninit::zeroed().assume_init() };
    estimate.reserved = UNWRITTEN;
    estimate
}

/// Codes as sample pairs of the core.
pub fn samples<S: Arithmetic>(codes: &[[i16; 2]]) -> Vec<[S; 2]> {
    codes.iter().map(|pair| pair.map(S::from)).collect()
}
