//! Any bytes at both ends of the line: `cargo +nightly fuzz run decoder` in `crates/antinode-telemetry`.
#![no_main]

use antinode_telemetry::{CommandFrame, Decoder, Frame, MAX_FRAME, ReportFrame, frame};
use libfuzzer_sys::fuzz_target;

/// Decodes; whatever is given must be a message that returns to the bit.
fn decode<M: Frame>(bytes: &[u8]) {
    let mut decoder = Decoder::<M>::new();
    for &byte in bytes {
        if let Some(Ok(message)) = decoder.push(byte) {
            let mut buffer = [0; MAX_FRAME];
            let sent = frame(&message, &mut buffer).expect("any message fits");
            let mut decoder = Decoder::<M>::new();
            let got = sent.iter().find_map(|&byte| decoder.push(byte));
            let mut again = [0; MAX_FRAME];
            let got = got.expect("a frame").expect("a sound one");
            assert_eq!(frame(&got, &mut again), Ok(sent));
        }
    }
    decoder.finish();
}

fuzz_target!(|bytes: &[u8]| {
    decode::<ReportFrame>(bytes);
    decode::<CommandFrame>(bytes);
    // The same behind a right checksum, which chance does not find.
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let payload = [bytes, &crc.checksum(bytes).to_le_bytes()].concat();
    let mut wire = vec![0; payload.len() + payload.len() / 254 + 2];
    cobs::encode(&payload, &mut wire);
    decode::<ReportFrame>(&wire);
    decode::<CommandFrame>(&wire);
});
