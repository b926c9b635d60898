//! Where the device's bytes come from: a port, a file, or standard input, read beside the thread that prints.

use std::fs::File;
use std::io::{self, Read};
use std::mem;
use std::path::{Path, PathBuf};
use std::process;
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
    /// True for a port, with a device that may have run for long.
    pub is_port: bool,
    /// Its bytes.
    pub input: Receiver<Input>,
}

impl Source {
    /// Opens a port, a file, or standard input where the path is `-`; to a port it sends `greeting` first.
    pub fn open(path: &Path, baud: u32, greeting: &[u8]) -> Result<Self, Failure> {
        let is_port = path != Path::new("-") && port::is_port(path);
        let (name, from): (String, Box<dyn Read + Send>) = if path == Path::new("-") {
            ("standard input".to_owned(), Box::new(io::stdin()))
        } else {
            let name = path.display().to_string();
            if is_port {
                let mut port = port::open(path, baud)?;
                // A line that only receives is good enough to listen.
                let _ = port.write_all(greeting);
                (name, Box::new(port))
            } else if path.is_file() || path.is_dir() {
                (name, Box::new(open_file(path)?))
            } else if path.exists() {
                (name, Box::new(Pipe::Named(path.to_owned())))
            } else {
                return Err(Failure::Fault(format!(
                    "{name}: there is neither such a port nor such a file; {}",
                    port::ports()
                )));
            }
        };
        // A few chunks ahead: a file of any size keeps memory as it is.
        let (sender, input) = sync_channel(4);
        end_on_interrupt(sender.clone())?;
        thread::spawn(move || read(from, &sender));
        Ok(Self {
            name,
            is_port,
            input,
        })
    }
}

/// A named pipe, which opens once somebody writes into it: whoever reads first waits for that, and whoever opens it need not.
enum Pipe {
    Named(PathBuf),
    Open(File),
}

impl Read for Pipe {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if let Self::Named(path) = self {
            *self = Self::Open(File::open(path)?);
        }
        match self {
            Self::Named(_) => Ok(0),
            Self::Open(file) => file.read(bytes),
        }
    }
}

/// Ends the input at Ctrl-C, after what was read before it; at the next one the command.
fn end_on_interrupt(sender: SyncSender<Input>) -> Result<(), Failure> {
    let mut is_asked = false;
    on_interrupt(move || {
        // Whoever reads the rows may have stopped: then they wait for ever.
        if mem::replace(&mut is_asked, true) {
            process::exit(Failure::Stopped.code().into());
        }
        let sender = sender.clone();
        thread::spawn(move || sender.send(Input::Interrupted));
    })
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
