//! The serial line: USART1, TX on PA9, RX on PA10, 8N1. Bytes leave by DMA in runs, and arrive by DMA in a ring.
//!
//! Interrupts per byte would lose bytes: one takes 11 µs, the USART holds one, and the samples' interrupt takes up to half a millisecond.

#![allow(
    unsafe_code,
    reason = "addresses for the DMA, and registers that take any bits"
)]

use stm32f4xx_hal::pac::{DMA2, RCC, USART1};

use crate::clocks::{baud_error_ppm, usart_divider};
use crate::hardware::clock;
use crate::inbox::Inbox;
use crate::link::{Outgoing, Run};
use crate::settings::{BAUD, INBOX};

/// Value of BRR.
const DIVIDER: u32 = usart_divider(BAUD);

const _: () = {
    assert!(
        DIVIDER >= 16 && DIVIDER < 1 << 16,
        "BAUD must be 1300 to 5_250_000"
    );
    assert!(
        baud_error_ppm(BAUD) < 10_000,
        "BAUD must be within 1 % of 84 MHz over a whole number, such as 115_200, 460_800, 921_600, 1_000_000 or 3_000_000"
    );
};

/// How bytes are transferred.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transfer {
    /// Streams 7 and 5 of DMA2, channel 4 (RM0090, 10.3.3).
    Dma,
    /// One by one by software, for the emulator: it has no DMA, and its USART takes a byte at once and keeps one until it is read.
    Software,
}

/// The line's end of both queues.
pub struct Line {
    usart: USART1,
    out: Outgoing<'static>,
    inbox: &'static Inbox,
    transfer: Transfer,
    /// Run that the DMA is sending.
    under_way: Option<Run<'static>>,
}

impl Line {
    /// Starts the line. RX must have its alternate function 7 before, and TX be given it after.
    pub fn new(
        usart: USART1,
        rcc: &RCC,
        out: Outgoing<'static>,
        inbox: &'static Inbox,
        transfer: Transfer,
    ) -> Self {
        // APB2ENR.USART1EN, AHB1ENR.DMA2EN: clocks on.
        rcc.apb2enr().modify(|_, w| w.usart1en().set_bit());
        rcc.ahb1enr().modify(|_, w| w.dma2en().set_bit());
        clock::settle();
        // SAFETY: the USART is off, and the divider within its 16 bits.
        usart.brr().write(|w| unsafe { w.bits(DIVIDER as u16) });
        let by_dma = transfer == Transfer::Dma;
        if by_dma {
            receive(inbox, usart.dr().as_ptr() as u32);
        }
        // CR3.DMAT, DMAR: DMA requests of the transmitter and of the receiver.
        usart
            .cr3()
            .write(|w| w.dmat().bit(by_dma).dmar().bit(by_dma));
        // CR1: on, in both directions; without DMA an interrupt for each byte received.
        usart.cr1().write(|w| {
            w.ue().set_bit();
            w.te().set_bit();
            w.re().set_bit();
            w.rxneie().bit(!by_dma)
        });
        Self {
            usart,
            out,
            inbox,
            transfer,
            under_way: None,
        }
    }

    /// Serves the line's interrupts, one of which the main loop pends if there may be bytes to send; if `open` is false they are held back.
    pub fn serve(&mut self, open: bool) {
        let status = self.usart.sr().read();
        if self.transfer == Transfer::Dma {
            if status.ore().bit_is_set() {
                // SR.ORE: after an overrun nothing more is received until SR and then DR are read.
                let _ = self.usart.dr().read();
            }
            // NDTR: places left before the ring's end. Bytes that it counts are in memory long before the main loop reads them.
            self.inbox
                .left(dma().st(5).ndtr().read().ndt().bits().into());
        } else if status.rxne().bit_is_set() {
            // SR.RXNE: a byte is there.
            self.inbox.put(self.usart.dr().read().bits() as u8);
        }
        if let Some(run) = self.under_way.take() {
            if !sent() {
                self.under_way = Some(run);
                return;
            }
            self.out.release(run);
        }
        if !open {
            return;
        }
        while let Some(run) = self.out.run() {
            if self.transfer == Transfer::Dma {
                send(&run, self.usart.dr().as_ptr() as u32);
                self.under_way = Some(run);
                return;
            }
            for &byte in run.iter() {
                self.usart.dr().write(|w| w.dr().set(u16::from(byte)));
            }
            self.out.release(run);
        }
    }
}

/// The DMA controller, of which the line uses streams 5 and 7.
fn dma() -> DMA2 {
    // SAFETY: nothing else uses streams 5 and 7 or HISR, or clears the flags of stream 7, which are write-one-to-clear in HIFCR.
    unsafe { DMA2::steal() }
}

/// True once stream 7 has ended, by its last byte or by an error; clears its flags.
fn sent() -> bool {
    let dma = dma();
    // Flags first: if the stream ends right after, its interrupt comes again.
    clear(&dma);
    // CR.EN: the stream clears it at its end.
    dma.st(7).cr().read().en().bit_is_clear()
}

/// Clears the flags of stream 7, by HIFCR.
fn clear(dma: &DMA2) {
    dma.hifcr().write(|w| {
        w.ctcif7().set_bit();
        w.chtif7().set_bit();
        w.cteif7().set_bit();
        w.cdmeif7().set_bit();
        w.cfeif7().set_bit()
    });
}

/// Starts stream 5, which fills the inbox endlessly.
fn receive(inbox: &'static Inbox, register: u32) {
    let dma = dma();
    let stream = dma.st(5);
    // SAFETY: the inbox is static, and its bytes are atomics, which may change at any time.
    unsafe {
        // PAR, M0AR, NDTR: from the USART's data register into the ring.
        stream.par().write(|w| w.bits(register));
        stream
            .m0ar()
            .write(|w| w.bits(inbox.places().as_ptr() as u32));
        stream.ndtr().write(|w| w.bits(INBOX as u32));
        // CHSEL 4: USART1_RX. DIR 0: from the peripheral. MINC, CIRC: along the ring, circular, byte by byte.
        stream.cr().write(|w| {
            w.chsel().bits(4);
            w.minc().set_bit();
            w.circ().set_bit()
        });
    }
    // EN: on, after all else is set (RM0090, 10.3.17).
    stream.cr().modify(|_, w| w.en().set_bit());
}

/// Starts stream 7 on a run.
fn send(run: &Run<'static>, register: u32) {
    let dma = dma();
    clear(&dma);
    let stream = dma.st(7);
    // SAFETY: the run's bytes stay in place until it is released, which is after the stream has ended.
    unsafe {
        // PAR, M0AR, NDTR: from the run to the USART's data register.
        stream.par().write(|w| w.bits(register));
        stream.m0ar().write(|w| w.bits(run.as_ptr() as u32));
        stream.ndtr().write(|w| w.bits(run.len() as u32));
        // CHSEL 4: USART1_TX. DIR 1: to the peripheral. MINC: along the run, byte by byte. TCIE, TEIE: interrupts at the end.
        stream.cr().write(|w| {
            w.chsel().bits(4);
            w.dir().bits(0b01);
            w.minc().set_bit();
            w.tcie().set_bit();
            w.teie().set_bit()
        });
    }
    // EN: on.
    stream.cr().modify(|_, w| w.en().set_bit());
}
