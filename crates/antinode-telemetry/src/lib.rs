//! The serial protocol between a gyro controller that runs [`antinode`] and a PC: reports to the PC, commands to the controller.
//!
//! # On the wire
//!
//! | part | bytes | content |
//! |---|---|---|
//! | `00` | 1 | delimiter, which ends any noise before it |
//! | COBS code | 1 | [Consistent Overhead Byte Stuffing](https://doi.org/10.1109/90.769765) removes the zeros from the bytes that follow |
//! | header | 1 | 2 × [`PROTOCOL_VERSION`], plus 1 in a command |
//! | number | 1 to 3 | a report's running number, or a command's id |
//! | body | | [`Report`] or [`Command`] in [postcard's format](https://postcard.jamesmunns.com/wire-format) |
//! | CRC | 4 | CRC-32 of header, number and body, that of Ethernet and zlib, lowest byte first |
//! | `00` | 1 | delimiter |
//!
//! In a body, fields follow each other in the order in which the types of this crate and of [`antinode`] declare them, an enum is the index
//! of its variant, and [`Flags`](antinode::Flags) are the number that their `bits` give.
//!
//! Noise that leaves the framing intact passes the CRC once in 2³² times, as one wrong bit of a COBS code is many wrong bits of the data.
//! A frame that is cut, too long, damaged or no frame at all is dropped and reported as [`Damage`]; the next delimiter starts afresh, so
//! noise costs only the frames that it touches. Floating-point values are sent bit for bit.
//!
//! An estimate takes at most [`MAX_FRAME`] bytes, about 110. At 921 600 baud, 8N1, a line carries 92 160 bytes and so some 800
//! estimates a second: windows of ten periods at 5.3 kHz make 530. Methods sent with every estimate double that.
//!
//! # Who sends what
//!
//! * The device sends [`Report::Hello`] at its start as number 0, on [`Command::Get`], and after each change of its configuration.
//! * The device answers every command with [`Report::Acknowledgement`] and its id: after the Hello, if the command causes one, and
//!   before the restart, if it asks for one.
//! * The device sends [`Report::Counters`] about once a second, and soon after blocks or pairs were lost; all else when it happens.
//!
//! # Features
//!
//! `mean-return`, on by default, is that of [`antinode`], whose settings are sent. Firmware that does without it sets `default-features =
//! false` for both crates: if one of them has the feature, both do.
//!
//! # Example
//!
//! The device numbers its reports with a [`Reporter`] and takes commands with a [`Decoder`], byte by byte as the USART gives them:
//!
//! ```
//! use antinode_telemetry::*;
//!
//! let mut configuration = Configuration::new(antinode::Settings::new(100_000.0), FrontEnd::DualAdc);
//! let mut reporter = Reporter::new();
//! let mut buffer = [0; MAX_FRAME];
//! let hello = reporter.frame(&Report::Hello(Hello::new("0.1.0", configuration)), &mut buffer)?;
//! // Hand `hello` to the DMA of the USART.
//! let mut wire = hello.to_vec(); // Here: to a vector.
//!
//! # let mut request = [0; MAX_FRAME];
//! # let received = frame(&CommandFrame { id: 7, command: Command::SetWindow { periods: 20 } }, &mut request)?;
//! let mut commands = Decoder::<CommandFrame>::new();
//! let mut damaged = 0;
//! for &byte in received {
//!     match commands.push(byte) {
//!         None => {}
//!         Some(Err(_)) => damaged += 1,
//!         Some(Ok(CommandFrame { id, command })) => {
//!             // A ring of 64 blocks.
//!             let result = configuration.after(&command, 64).map(|new| configuration = new);
//!             let report = Report::Acknowledgement(Acknowledgement { id, result });
//!             wire.extend(reporter.frame(&report, &mut buffer)?);
//!         }
//!     }
//! }
//! assert_eq!(configuration.settings.periods, 20);
//!
//! // The PC reads with a `Receiver`, which counts what is lost.
//! let mut receiver = Receiver::new();
//! let reports: Vec<_> = wire.iter().filter_map(|&byte| receiver.push(byte)).collect();
//! assert!(matches!(reports[0], Ok(Report::Hello(_))));
//! assert_eq!(reports[1], Ok(Report::Acknowledgement(Acknowledgement { id: 7, result: Ok(()) })));
//! assert_eq!((receiver.lost(), receiver.damaged(), damaged), (0, 0, 0));
//! # Ok::<(), BufferTooSmall>(())
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod command;
mod configuration;
mod decoder;
mod frame;
mod link;
mod numbers;
mod report;

pub use command::{Command, CommandError};
pub use configuration::{Configuration, FrontEnd};
pub use decoder::{Damage, Decoder};
pub use frame::{BufferTooSmall, CommandFrame, Frame, ReportFrame, frame};
pub use link::{Receiver, Reporter};
pub use numbers::{Numbers, Place};
pub use report::FIRMWARE_BYTES;
pub use report::{Acknowledgement, Cause, Counters, Hello, MethodValues, Methods, Report, State};

/// Version of the protocol. It is in every frame, and changes with every change of a message.
pub const PROTOCOL_VERSION: u8 = 8;

/// Longest frame on the wire, bytes, delimiters included.
pub const MAX_FRAME: usize = frame::MAX_PAYLOAD + 3;
