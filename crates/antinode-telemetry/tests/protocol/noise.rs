//! Whatever the line does to the bytes, the decoder neither panics nor gives what was not sent, and loses only what was touched.

use crate::any::{bytes, command_frame, decode, report_frame};
use antinode_telemetry::*;
use proptest::collection::vec;
use proptest::prelude::*;

/// The header of a report.
const HEADER: u8 = 2 * PROTOCOL_VERSION;

/// Noise: bytes of every value, with many zeros and long runs among them.
fn noise(most: usize) -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![
        4 => any::<u8>(),
        1 => Just(0),
        1 => 1u8..4,
        1 => Just(0xff),
    ];
    prop_oneof![vec(byte, 0..most), vec(1u8.., 0..most)]
}

/// The frames of all messages that a decoder gives.
fn sound<M: Frame>(wire: &[u8]) -> Vec<Vec<u8>> {
    let messages = decode::<M>(wire).into_iter().flatten();
    messages.map(|message| bytes(&message)).collect()
}

/// A frame of any content, its checksum right.
fn checked(content: &[u8]) -> Vec<u8> {
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let payload = [content, &crc.checksum(content).to_le_bytes()].concat();
    let mut frame = vec![0; payload.len() + payload.len() / 254 + 2];
    let length = cobs::encode(&payload, &mut frame);
    frame.truncate(length + 1);
    frame
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn noise_between_frames_costs_none(
        frames in vec((noise(400), report_frame()), 1..8),
        end in noise(400),
    ) {
        let mut wire = Vec::new();
        for (noise, frame) in &frames {
            wire.extend(noise);
            wire.extend(bytes(frame));
        }
        wire.extend(end);
        let sent: Vec<_> = frames.iter().map(|(_, frame)| bytes(frame)).collect();
        prop_assert_eq!(sound::<ReportFrame>(&wire), sent);
    }

    #[test]
    fn damage_costs_the_frames_it_touches(
        frames in vec(report_frame(), 3..6),
        place in any::<prop::sample::Index>(),
        what in 0..4,
        flips in vec((0usize..40, 0u32..8), 1..5),
    ) {
        let sent: Vec<_> = frames.iter().map(bytes).collect();
        let hurt = place.index(sent.len());
        let mut frame = sent[hurt].clone();
        let at = place.index(frame.len() - 2) + 1;
        match what {
            0 => { frame.remove(at); }
            1 => frame.truncate(at),
            2 => { frame.drain(..at); }
            _ => for &(offset, bit) in &flips {
                let length = frame.len();
                frame[(at + offset) % length] ^= 1 << bit;
            }
        }
        let whole = frame == sent[hurt];
        let wire = [&sent[..hurt], &[frame], &sent[hurt + 1..]].concat().concat();
        let mut expected = sent.clone();
        if !whole {
            expected.remove(hurt);
        }
        let got = sound::<ReportFrame>(&wire);
        // Only what was cut away at the ends, a delimiter, or its mirror in the neighbour's, leaves a touched frame sound.
        prop_assert!(got == expected || got == sent, "{:?}", got.len());
    }

    #[test]
    fn every_single_bit_is_guarded(frame in report_frame()) {
        let sent = bytes(&frame);
        for bit in 8..8 * (sent.len() - 1) {
            let mut wire = sent.clone();
            wire[bit / 8] ^= 1 << (bit % 8);
            let got = decode::<ReportFrame>(&wire);
            prop_assert!(!got.is_empty() && got.iter().all(Result::is_err), "bit {bit}: {got:?}");
        }
    }

    #[test]
    fn a_cut_frame_is_told_once(frame in report_frame(), place in any::<prop::sample::Index>()) {
        let sent = bytes(&frame);
        let at = 2 + place.index(sent.len() - 2);
        let got = decode::<ReportFrame>(&sent[..at]);
        prop_assert_eq!(got.len(), 1);
        prop_assert!(got[0].is_err(), "{at}: {got:?}");
    }

    #[test]
    fn the_other_direction_is_told(report in report_frame(), command in command_frame()) {
        prop_assert_eq!(decode::<CommandFrame>(&bytes(&report)), [Err(Damage::Header(2 * PROTOCOL_VERSION))]);
        prop_assert_eq!(decode::<ReportFrame>(&bytes(&command)), [Err(Damage::Header(2 * PROTOCOL_VERSION + 1))]);
    }
}

proptest! {
    // What the fuzz target does, briefly, on any machine.
    #![proptest_config(ProptestConfig::with_cases(100_000))]

    #[test]
    fn noise_alone_gives_damage_alone(noise in noise(300)) {
        for result in decode::<ReportFrame>(&noise) {
            prop_assert!(result.is_err());
        }
        for result in decode::<CommandFrame>(&noise) {
            prop_assert!(result.is_err());
        }
    }

    #[test]
    fn noise_with_a_right_checksum_is_a_message_or_damage(
        header in prop_oneof![9 => HEADER..HEADER + 2, 1 => any::<u8>()],
        number in 0u8..128,
        tag in 0u8..8,
        body in vec(any::<u8>(), 0..140),
    ) {
        let content = [&[header, number, tag][..], &body].concat();
        let wire = checked(&content);
        for got in decode::<ReportFrame>(&wire) {
            match got {
                Ok(message) => prop_assert!(bytes(&message).len() <= MAX_FRAME),
                Err(damage) => prop_assert_eq!(
                    damage == Damage::TooLong,
                    content.len() + 4 > MAX_FRAME - 3,
                    "{:?}", damage
                ),
            }
        }
        prop_assert_eq!(decode::<CommandFrame>(&wire).len(), 1);
    }
}

#[test]
fn another_version_is_named() {
    let got = decode::<ReportFrame>(&checked(&[18, 0, 2, 2]));
    assert_eq!(got, [Err(Damage::Header(18))]);
    assert!(Damage::Header(18).to_string().contains("version 9"));
    // This version's other direction is no other version.
    for header in [2 * PROTOCOL_VERSION, 2 * PROTOCOL_VERSION + 1] {
        let told = Damage::Header(header).to_string();
        assert!(
            told.contains("other direction") && !told.contains("version"),
            "{told}"
        );
    }
}

#[test]
fn content_beyond_this_version_is_told() {
    // No such report; a report with a byte too many; one too few.
    for content in [&[HEADER, 0, 99][..], &[HEADER, 0, 2, 2, 0], &[HEADER, 0, 2]] {
        assert_eq!(
            decode::<ReportFrame>(&checked(content)),
            [Err(Damage::Content)]
        );
    }
}

#[test]
fn flags_beyond_this_version_are_told() {
    let flags = |bits: u16| {
        let mut buffer = [0; 3];
        let bytes = postcard::to_slice(&bits, &mut buffer).unwrap();
        postcard::from_bytes::<antinode::Flags>(bytes)
    };
    assert_eq!(flags(0x1ff).map(antinode::Flags::bits), Ok(0x1ff));
    for bits in [0x200, 0x201, u16::MAX] {
        assert!(flags(bits).is_err(), "{bits:#x}");
    }
}

#[test]
fn a_frame_too_long_is_told_once_and_the_next_is_whole() {
    let command = CommandFrame {
        id: 1,
        command: Command::Get,
    };
    let wire = [vec![0x55; 5000], bytes(&command)].concat();
    assert_eq!(decode(&wire), [Err(Damage::TooLong), Ok(command)]);
}

#[test]
fn a_receiver_counts_damage_and_loss() {
    let mut reporter = Reporter::new();
    let mut wire = b"garbage".to_vec();
    for number in 0..10 {
        let mut buffer = [0; MAX_FRAME];
        let report = Report::State(State::Searching);
        let length = reporter.frame(&report, &mut buffer).unwrap().len();
        match number {
            3 => continue,
            5 => buffer[4] ^= 0x10,
            _ => {}
        }
        wire.extend(&buffer[..length]);
    }
    wire.extend([0, 9, 9]);
    let mut receiver = Receiver::new();
    for byte in wire {
        receiver.push(byte);
    }
    assert_eq!(receiver.finish(), Some(Damage::Framing));
    assert_eq!(receiver.finish(), None);
    // Garbage, the flipped frame, the rest at the end; number 3 and the flipped 5.
    assert_eq!(
        (receiver.reports(), receiver.damaged(), receiver.lost()),
        (8, 3, 2)
    );
}
