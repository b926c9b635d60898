//! The serial line: USART1, TX on PA9, RX on PA10, 8N1, a byte an interrupt each way.

use heapless::spsc::{Consumer, Producer};
use stm32f4xx_hal::pac::{RCC, USART1};

use crate::hardware::clock::APB2;
use crate::settings::{BAUD, INBOX, OUTBOX};

/// BRR: the divider in sixteenths of 16 samples a bit, that is APB2's clock over the baud rate, rounded.
const DIVIDER: u32 = (APB2 + BAUD / 2) / BAUD;

const _: () = {
    assert!(DIVIDER >= 16 && DIVIDER < 1 << 16, "the baud rate is out of the USART's reach");
    let error = (APB2 / DIVIDER).abs_diff(BAUD);
    assert!(error < BAUD / 100, "the baud rate is more than 1 % off");
};

/// The line's end of both byte queues.
pub struct Line {
    usart: USART1,
    out: Consumer<'static, u8, OUTBOX>,
    bytes: Producer<'static, u8, INBOX>,
}

impl Line {
    /// Starts the line; the pins must be set to their alternate function 7.
    pub fn new(
        usart: USART1,
        rcc: &RCC,
        out: Consumer<'static, u8, OUTBOX>,
        bytes: Producer<'static, u8, INBOX>,
    ) -> Self {
        // APB2ENR.USART1EN: its clock.
        rcc.apb2enr().modify(|_, w| w.usart1en().set_bit());
        set_divider(&usart);
        // CR1: on, both ways, an interrupt for each byte that arrives.
        usart.cr1().write(|w| {
            w.ue().set_bit();
            w.te().set_bit();
            w.re().set_bit();
            w.rxneie().set_bit()
        });
        Self { usart, out, bytes }
    }

    /// Serves the interrupt, which the main loop pends when there are bytes to send; `open` false holds them back.
    pub fn serve(&mut self, open: bool) {
        // SR.RXNE: a byte is there. Reading SR and then DR clears an overrun (ORE) too; the frame's checksum misses the byte.
        let status = self.usart.sr().read();
        if status.rxne().bit_is_set() || status.ore().bit_is_set() {
            let byte = self.usart.dr().read().bits() as u8;
            if status.rxne().bit_is_set() {
                // A full queue drops the byte, which its frame's checksum misses as well.
                let _ = self.bytes.enqueue(byte);
            }
        }
        // SR.TXE: DR takes a byte.
        while open && self.usart.sr().read().txe().bit_is_set() {
            match self.out.dequeue() {
                Some(byte) => self.usart.dr().write(|w| w.dr().set(u16::from(byte))),
                None => break,
            };
        }
        // CR1.TXEIE: call again as long as there is more.
        let more = open && self.out.ready();
        self.usart.cr1().modify(|_, w| w.txeie().bit(more));
    }

    /// Sends nothing more and waits for nothing: true when the last byte has left.
    pub fn is_idle(&self) -> bool {
        self.usart.sr().read().tc().bit_is_set()
    }
}

#[allow(unsafe_code, reason = "the register takes any bits")]
fn set_divider(usart: &USART1) {
    // SAFETY: the USART is off, and the divider within its 16 bits.
    usart.brr().write(|w| unsafe { w.bits(DIVIDER as u16) });
}
