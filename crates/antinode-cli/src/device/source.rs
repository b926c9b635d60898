//! The source of a device's bytes: a port, a file, or standard input, read in a thread beside the one that prints.

use std::fs::File;
use std::io::{self, Read};
use std::mem;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use super::port;
use crate::failure::Failure;
use crate::interrupt::on_interrupt;
use crate::recording::{STANDARD_INPUT, open_file};

/// What comes from a source.
pub enum Input {
    /// Some bytes.
    Bytes(Vec<u8>),
    /// No more.
    End,
    /// No more, and this is why.
    Fault(io::Error),
    /// The user pressed Ctrl-C.
    Interrupted,
}

/// A source of bytes.
pub struct Source {
    /// What to call it in messages.
    pub name: String,
    /// True for a port, whose device may have been running before.
    pub is_port: bool,
    /// Its bytes.
    pub input: Receiver<Input>,
}

impl Source {
    /// Opens a port, a file, or standard input where the path is `-`; to a port it sends `greeting` first.
    pub fn open(path: &Path, baud: u32, greeting: &[u8]) -> Result<Self, Failure> {
        let is_port = path != Path::new("-") && port::is_port(path);
        let (name, from): (String, Box<dyn Read + Send>) = if path == Path::new("-") {
            (STANDARD_INPUT.to_owned(), Box::new(io::stdin()))
        } else {
            let name = path.display().to_string();
            if is_port {
                let mut port = port::open(path, baud)?;
                // To listen, a line need not be able to send.
                let _ = port.write_all(greeting);
                (name, Box::new(port))
            } else if path.is_file() || path.is_dir() {
                (name, Box::new(open_file(path)?))
            } else if path.exists() {
                (name, Box::new(Pipe(path.to_owned(), None)))
            } else {
                return Err(Failure::Fault(format!(
                    "{name}: there is no port and no file of this name; {}",
                    port::ports()
                )));
            }
        };
        // Only a few chunks are read ahead, so that memory does not grow with the file.
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

/// A named pipe, and the file once it is open. Opening it waits for a writer, so the first read does that, in the thread that reads.
struct Pipe(PathBuf, Option<File>);

impl Read for Pipe {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let Self(path, open) = self;
        match open {
            Some(file) => file.read(bytes),
            None => open.insert(File::open(path)?).read(bytes),
        }
    }
}

/// How long SIGTERM leaves for what was read before it.
const TERMINATION: Duration = Duration::from_millis(500);

/// Has the first Ctrl-C end the input, after what was read before it, and the next one end the command, as SIGTERM does by itself.
fn end_on_interrupt(sender: SyncSender<Input>) -> Result<(), Failure> {
    let mut is_asked = false;
    on_interrupt(move |is_termination| {
        // Where nobody reads the rows any more, printing them waits for ever, and the input's end is never seen.
        let stop = || process::exit(Failure::Stopped.code().into());
        if mem::replace(&mut is_asked, true) {
            stop();
        }
        let sender = sender.clone();
        thread::spawn(move || sender.send(Input::Interrupted));
        if is_termination {
            thread::sleep(TERMINATION);
            stop();
        }
    })
}

/// Reads `from` a source until it ends or the receiver has gone.
fn read(mut from: impl Read, to: &SyncSender<Input>) {
    let mut buffer = vec![0; 1 << 16];
    loop {
        let input = match from.read(&mut buffer) {
            Ok(0) => Input::End,
            Ok(length) => Input::Bytes(buffer[..length].to_vec()),
            Err(error) => match error.kind() {
                // The line is silent, or a signal came.
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
