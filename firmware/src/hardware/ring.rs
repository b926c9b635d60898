//! The DMA's ring of packed pairs: stream 0 of DMA2 in circular mode, with an interrupt at its half and at its end.

#![allow(
    unsafe_code,
    reason = "addresses for the DMA, and memory that it writes"
)]

use core::sync::atomic::{Ordering, fence};

use antinode::Packed;
use stm32f4xx_hal::pac::DMA2;

use crate::sampler::{Done, Ring};
use crate::settings::HALF;

/// The ring's memory: two halves.
pub type Memory = [[Packed; HALF]; 2];

/// Source of the words.
#[derive(Debug, Clone, Copy)]
pub struct Origin {
    /// The data register's address.
    pub register: u32,
    /// The request's channel on stream 0, RM0090, 10.3.3.
    pub channel: u8,
    /// True if a pair comes as two words of 16 bits, S_C first, rather than as one of 32.
    pub by_halves: bool,
}

/// The ring and its stream.
pub struct Stream {
    dma: DMA2,
    memory: *mut Memory,
    origin: Origin,
}

// SAFETY: the ring owns the memory for ever.
unsafe impl Send for Stream {}

impl Stream {
    /// A stopped ring. DMA2's clock must be enabled.
    pub fn new(dma: DMA2, memory: &'static mut Memory, origin: Origin) -> Self {
        Self {
            dma,
            memory,
            origin,
        }
    }
}

impl Ring for Stream {
    /// Stops the stream; its source may be switched off only after that (RM0090, 10.3.17).
    fn stop(&mut self) {
        let stream = self.dma.st(0);
        // CR.EN: off; it reads as on until the current transfer has ended, within some bus cycles.
        stream.cr().modify(|_, w| w.en().clear_bit());
        let _ = (0..1000).any(|_| stream.cr().read().en().bit_is_clear());
    }

    fn start(&mut self) {
        let stream = self.dma.st(0);
        // The stream cannot be enabled while flags are set.
        self.done();
        let transfers = if self.origin.by_halves {
            4 * HALF
        } else {
            2 * HALF
        };
        // SAFETY: the source is a data register; the target is memory that belongs to the DMA for ever, of the size of a round.
        unsafe {
            // PAR, M0AR: from the data register into the ring. NDTR: transfers a round.
            stream.par().write(|w| w.bits(self.origin.register));
            stream.m0ar().write(|w| w.bits(self.memory as u32));
            stream.ndtr().write(|w| w.bits(transfers as u32));
            let size = if self.origin.by_halves { 0b01 } else { 0b10 };
            stream.cr().write(|w| {
                // CHSEL: the request. PL 3: highest priority. MSIZE, PSIZE: 16 or 32 bits.
                w.chsel().bits(self.origin.channel);
                w.pl().bits(0b11);
                w.msize().bits(size);
                w.psize().bits(size);
                // MINC: along the ring. CIRC: circular. DIR 0: from the peripheral.
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

    /// Pairs still to come in this round, by NDTR, with one of which only the first word has come.
    fn left(&self) -> u32 {
        let transfers = self.dma.st(0).ndtr().read().bits();
        if self.origin.by_halves {
            transfers.div_ceil(2)
        } else {
            transfers
        }
    }

    /// Reads and clears the events of the stream: LISR, LIFCR.
    fn done(&self) -> Done {
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
            // A direct-mode or FIFO error is ignored: no word is lost by it.
            w.cdmeif0().set_bit();
            w.cfeif0().set_bit()
        });
        done
    }

    fn half(&self, second: bool) -> &[Packed] {
        // Reads the words only after the DMA's flag.
        fence(Ordering::Acquire);
        // SAFETY: the half lies within the memory, and only the DMA writes, to the other half. If it comes round too early, the words
        // are valid but new, and by `Source::is_intact` their results are discarded.
        unsafe {
            core::slice::from_raw_parts(
                self.memory.cast::<Packed>().add(usize::from(second) * HALF),
                HALF,
            )
        }
    }
}
