//! Where the device's bytes come from: a port, a file, or standard input, read beside the thread that prints.

use std::io::{self, Read};
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use super::port;
use crate::failure::Failure;
use crate::interrupt::on_interrupt;
use crate::recording::open_file;

/// What comes from a source.
pub enum Input {
    /// Some bytes.
    Bytes(Vec<u8>),
    /// No more.
    End,
    /// No more, and this is why.
    Fault(io::Error),
    /// The user has had enough.
    Interrupted,
}

/// A source of bytes.
pub struct Source {
    /// What to call it in messages.
    pub name: String,
    /// Its bytes.
    pub input: Receiver<Input>,
}

impl Source {
    /// Opens a port, a file, or standard input where the path is `-`; to a port it sends `greeting` first.
    pub fn open(path: &Path, baud: u32, greeting: &[u8]) -> Result<Self, Failure> {
        let name = path.display().to_string();
        // A few chunks ahead: a file of any size keeps memory as it is.
        let (sender, input) = sync_channel(4);
        let interrupt = sender.clone();
        on_interrupt(move || {
            let _ = interrupt.send(Input::Interrupted);
        })?;
        if path == Path::new("-") {
            thread::spawn(move || read(io::stdin(), &sender));
            let name = "standard input".to_owned();
            return Ok(Self { name, input });
        }
        if port::is_port(path) {
            let mut port = port::open(path, baud)?;
            // A line that only receives is good enough to listen.
            let _ = port.write_all(greeting);
            thread::spawn(move || read(port, &sender));
        } else if path.exists() {
            let file = open_file(path)?;
            thread::spawn(move || read(file, &sender));
        } else {
            return Err(Failure::Recording(format!(
                "{name}: there is neither such a port nor such a file; {}",
                port::ports()
            )));
        }
        Ok(Self { name, input })
    }
}

/// Reads until the end, or until nobody listens any more.
fn read(mut from: impl Read, to: &SyncSender<Input>) {
    let mut buffer = vec![0; 1 << 16];
    loop {
        let input = match from.read(&mut buffer) {
            Ok(0) => Input::End,
            Ok(length) => Input::Bytes(buffer[..length].to_vec()),
            Err(error) => match error.kind() {
                // A silent line.
                io::ErrorKind::TimedOut | io::ErrorKind::Interrupted => continue,
                _ => Input::Fault(error),
            },
        };
        let last = !matches!(input, Input::Bytes(_));
        if to.send(input).is_err() || last {
            return;
        }
    }
}
