//! The DMA's ring of packed pairs: stream 0 of DMA2 in circular mode, an interrupt at its half and at its end.

#![allow(
    unsafe_code,
    reason = "addresses for the DMA, and memory that it writes"
)]

use core::sync::atomic::{Ordering, fence};

use antinode::Packed;
use stm32f4xx_hal::pac::DMA2;

use crate::settings::HALF;

/// The ring's memory: two halves.
pub type Memory = [[Packed; HALF]; 2];

/// What the stream has done since it was last asked.
#[derive(Debug, Clone, Copy)]
pub struct Done {
    /// The first half is full.
    pub first: bool,
    /// The second half is full.
    pub second: bool,
    /// The transfer failed.
    pub error: bool,
}

/// Where the words come from.
#[derive(Debug, Clone, Copy)]
pub struct Origin {
    /// The data register's address.
    pub register: u32,
    /// The request's channel on stream 0, RM0090, 10.3.3.
    pub channel: u8,
    /// True where a pair comes as two words of 16 bits, S_C first, rather than as one of 32.
    pub by_halves: bool,
}

/// The ring and its stream.
pub struct Ring {
    dma: DMA2,
    memory: *mut Memory,
    origin: Origin,
}

// SAFETY: the memory is the ring's own for ever.
unsafe impl Send for Ring {}

impl Ring {
    /// A stopped ring. DMA2's clock must be on.
    pub fn new(dma: DMA2, memory: &'static mut Memory, origin: Origin) -> Self {
        Self {
            dma,
            memory,
            origin,
        }
    }

    /// Stops the stream; only then may what it fetches from be switched off (RM0090, 10.3.17).
    pub fn stop(&mut self) {
        let stream = self.dma.st(0);
        // CR.EN: off; it reads as on until the transfer under way has ended, within some bus cycles.
        stream.cr().modify(|_, w| w.en().clear_bit());
        let _ = (0..1000).any(|_| stream.cr().read().en().bit_is_clear());
    }

    /// Starts the stopped stream at the ring's first word.
    pub fn start(&mut self) {
        let stream = self.dma.st(0);
        // With flags left it could not be switched on.
        self.done();
        let transfers = if self.origin.by_halves {
            4 * HALF
        } else {
            2 * HALF
        };
        // SAFETY: source and target are a data register and memory that is the DMA's for ever, of as many bytes as there are transfers.
        unsafe {
            // PAR, M0AR: from the data register into the ring. NDTR: transfers a round.
            stream.par().write(|w| w.bits(self.origin.register));
            stream.m0ar().write(|w| w.bits(self.memory as u32));
            stream.ndtr().write(|w| w.bits(transfers as u32));
            let size = if self.origin.by_halves { 0b01 } else { 0b10 };
            stream.cr().write(|w| {
                // CHSEL: the request. PL 3: no other stream goes first. MSIZE, PSIZE: 16 or 32 bits.
                w.chsel().bits(self.origin.channel);
                w.pl().bits(0b11);
                w.msize().bits(size);
                w.psize().bits(size);
                // MINC: along the ring. CIRC: round and round. DIR 0: from the peripheral.
                w.minc().set_bit();
                w.circ().set_bit();
                // HTIE, TCIE, TEIE: interrupts at the half, at the end, and at an error of the bus.
                w.htie().set_bit();
                w.tcie().set_bit();
                w.teie().set_bit();
                w
            });
        }
        stream.cr().modify(|_, w| w.en().set_bit());
    }

    /// Pairs that are still to come in this round: NDTR. A pair of which one word has come is one.
    pub fn left(&self) -> u32 {
        let transfers = self.dma.st(0).ndtr().read().bits();
        if self.origin.by_halves {
            transfers.div_ceil(2)
        } else {
            transfers
        }
    }

    /// Reads and clears what the stream has done: LISR, LIFCR.
    pub fn done(&self) -> Done {
        let status = self.dma.lisr().read();
        let done = Done {
            first: status.htif0().bit_is_set(),
            second: status.tcif0().bit_is_set(),
            error: status.teif0().bit_is_set(),
        };
        self.dma.lifcr().write(|w| {
            w.chtif0().bit(done.first);
            w.ctcif0().bit(done.second);
            w.cteif0().bit(done.error);
            // A direct-mode error or a FIFO error means nothing here: no word is lost by it.
            w.cdmeif0().set_bit();
            w.cfeif0().set_bit()
        });
        done
    }

    /// One of the halves; the DMA writes to the other one meanwhile, and the caller asks later whether it still did.
    pub fn half(&self, second: bool) -> &[Packed] {
        // What the DMA wrote before its flag is read after it.
        fence(Ordering::Acquire);
        // SAFETY: within the memory; nobody but the DMA writes, to the other half. Were it to come round too early, the words read
        // would be valid but new, and `Source::is_intact` throws away what was made of them.
        unsafe {
            core::slice::from_raw_parts(
                self.memory.cast::<Packed>().add(usize::from(second) * HALF),
                HALF,
            )
        }
    }
}
