//! A line of text for the debugger or the emulator, composed without `core::fmt`, which would link in panics.

use cortex_m_semihosting::hio;

/// A line of up to 128 bytes; further bytes are left out.
pub struct TextLine {
    bytes: [u8; 128],
    length: usize,
}

impl TextLine {
    /// An empty line.
    pub const fn new() -> Self {
        Self {
            bytes: [0; 128],
            length: 0,
        }
    }

    /// Adds text.
    pub fn text(&mut self, text: &str) {
        text.bytes().for_each(|byte| self.byte(byte));
    }

    fn byte(&mut self, byte: u8) {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
    }

    /// Adds a number in decimal.
    pub fn number(&mut self, number: u32) {
        if number >= 10 {
            self.number(number / 10);
        }
        self.byte(b'0' + (number % 10) as u8);
    }

    /// Adds ` name=number`.
    pub fn field(&mut self, name: &str, number: u32) {
        self.text(" ");
        self.text(name);
        self.text("=");
        self.number(number);
    }

    /// Ends the line and hands it to the host.
    pub fn print(mut self) {
        self.text("\n");
        if let (Ok(mut host), Some(bytes)) = (hio::hstdout(), self.bytes.get(..self.length)) {
            // An error means that no host listens: there is nobody to report it to.
            let _ = host.write_all(bytes);
        }
    }
}

impl Default for TextLine {
    fn default() -> Self {
        Self::new()
    }
}
