//! Opening of recordings, and what all formats have in common.

use std::fs;
use std::io::{self, Cursor, Read};
use std::iter;
use std::path::MAIN_SEPARATOR;

use proptest::prelude::*;

use super::*;

/// A stream that gives no more than a few bytes at a time.
pub(super) struct Dribble {
    bytes: Cursor<Vec<u8>>,
    most: usize,
}

impl Dribble {
    pub fn new(bytes: Vec<u8>, most: usize) -> Self {
        Self {
            bytes: Cursor::new(bytes),
            most,
        }
    }
}

impl Read for Dribble {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let most = self.most.min(bytes.len());
        self.bytes.read(&mut bytes[..most])
    }
}

/// All pairs up to the end or the first fault, after which there must be nothing more.
pub(super) fn drain(recording: &mut Recording) -> (Vec<[f32; 2]>, Option<Failure>) {
    let (mut all, mut block) = (Vec::new(), Vec::with_capacity(13));
    let fault = loop {
        match recording.read(&mut block) {
            Ok(0) => break None,
            Ok(count) => {
                assert_eq!(count, block.len());
                assert!(count <= 13);
                recording.look(all.len() as u64, &block);
                all.extend_from_slice(&block);
            }
            Err(fault) => break Some(fault),
        }
    };
    assert!(matches!(recording.read(&mut block), Ok(0)));
    while recording.next_gap().is_some() {
        recording.pass_gap(true);
    }
    (all, fault)
}

/// The text of a fault, which must be there.
pub(super) fn message(fault: Option<Failure>) -> String {
    fault.map(|fault| fault.to_string()).expect("a fault")
}

/// Writes a file into a directory that is deleted with the value returned.
pub(super) fn file(name: &str, bytes: &[u8]) -> (tempfile::TempDir, std::path::PathBuf) {
    let directory = tempfile::tempdir().expect("a directory for the test");
    let path = directory.path().join(name);
    fs::write(&path, bytes).expect("a file for the test");
    (directory, path)
}

/// Writes a file of this name, opens it as a recording, and reads all of it.
pub(super) fn read(name: &str, bytes: &[u8]) -> (Vec<[f32; 2]>, Option<String>) {
    read_with(name, bytes, &OpenOptions::default())
}

/// [`read`] with options; the message has no path before the name. An error reported at the end counts as a fault.
pub(super) fn read_with(
    name: &str,
    bytes: &[u8],
    options: &OpenOptions,
) -> (Vec<[f32; 2]>, Option<String>) {
    let (directory, path) = file(name, bytes);
    let (pairs, fault) = match Recording::open(&path, options) {
        Ok(mut recording) => {
            let (pairs, fault) = drain(&mut recording);
            let told = fault.or_else(|| recording.lost());
            (pairs, told.or_else(|| recording.not_finite()))
        }
        Err(fault) => (Vec::new(), Some(fault)),
    };
    let fault = fault.map(|fault| without(directory.path(), &fault));
    (pairs, fault)
}

/// The text of a fault, with the path of this directory left out.
pub(super) fn without(directory: &Path, fault: &dyn std::error::Error) -> String {
    let prefix = format!("{}{MAIN_SEPARATOR}", directory.display());
    fault.to_string().replace(&prefix, "")
}

/// The options for raw samples of this kind.
pub(super) fn raw(kind: Kind) -> OpenOptions {
    OpenOptions {
        raw: Some(kind),
        ..OpenOptions::default()
    }
}

fn open_fault(path: &Path) -> String {
    message(Recording::open(path, &OpenOptions::default()).err())
}

#[test]
fn a_path_that_leads_to_no_recording_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("none.wav");
    let name = path.display();
    assert_eq!(
        open_fault(&path),
        format!("{name}: there is no such file; check the path")
    );
    let expected = format!(
        "{}: this is a directory; name the file inside it",
        directory.path().display()
    );
    assert_eq!(open_fault(directory.path()), expected);
    assert!(open_fault(Path::new("/proc/self/mem")).contains(": cannot be read: "));
}

#[test]
fn a_file_that_may_not_be_read_is_named() {
    let fault = unreadable("a.wav", io::ErrorKind::PermissionDenied.into());
    assert!(
        fault
            .to_string()
            .starts_with("a.wav: no permission to read it; grant")
    );
}

#[test]
fn content_that_is_no_recording_is_named() {
    for (name, bytes, expected) in [
        ("a.wav", &b""[..], "a.wav: there is nothing in it; check"),
        (
            "a.wav",
            b"no sound and more",
            "a.wav: this is not a WAV file, although its extension says so; ",
        ),
        (
            "a.npy",
            b"no array and more",
            "a.npy: this is not an NPY file, although its extension says so; ",
        ),
        (
            "a.dat",
            b"MATHLAB 5.0 MAT-file",
            "a.dat: the format is not known, neither by content nor by extension; give a .wav",
        ),
        (
            "a.dat",
            b"\xff\xfeM\0A\0T\0",
            "a.dat: the format is not known, neither by content nor by extension; give a .wav",
        ),
    ] {
        let (pairs, fault) = read(name, bytes);
        assert!(pairs.is_empty());
        let fault = fault.expect("a fault");
        assert!(fault.starts_with(expected), "{fault}");
    }
}

#[test]
fn text_may_be_utf_16() {
    let text = "\u{feff}# µs\nc,d\r\n0.5,-0.25\r\n0.25,x\r\n";
    let little = text.encode_utf16().flat_map(u16::to_le_bytes);
    let big = text.encode_utf16().flat_map(u16::to_be_bytes);
    for bytes in [little.collect::<Vec<u8>>(), big.collect()] {
        for name in ["a.csv", "a.dat"] {
            let (pairs, fault) = read(name, &bytes);
            assert_eq!(pairs[0], [0.5, -0.25]);
            let expected =
                format!("{name}:4:2: sample pair 1 (from 0), S_D (right): the value is `x`");
            assert!(fault.as_ref().unwrap().starts_with(&expected), "{fault:?}");
        }
    }
    // Without a byte order mark, a zero in every other byte shows UTF-16.
    let little = "1,2\n".encode_utf16().flat_map(u16::to_le_bytes);
    let big = "1,2\n".encode_utf16().flat_map(u16::to_be_bytes);
    for bytes in [little.collect::<Vec<u8>>(), big.collect()] {
        for name in ["a.csv", "a.dat"] {
            assert_eq!(read(name, &bytes), (vec![[1.0, 2.0]], None));
        }
        // Raw samples may begin so, too.
        let (pairs, _) = read_with("a", &bytes, &raw(Kind::I16));
        assert_eq!(pairs.len(), 2);
    }
    // Progress counts the bytes of the file, up to all of them.
    let (_directory, path) = file(
        "a.csv",
        &"\u{feff}1,2\n"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<u8>>(),
    );
    let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
    drain(&mut recording);
    assert_eq!(Some(recording.bytes_read()), recording.bytes_total);
    // Raw samples may begin with any of these marks.
    let options = raw(Kind::I16);
    let (pairs, fault) = read_with("a", b"\xff\xfe\0\x40", &options);
    assert_eq!((pairs, fault), (vec![[-257.0 / 32768.0, 0.5]], None));
    // A file with the extension of a text is decoded all the same.
    let text: Vec<u8> = "\u{feff}1,2\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let (pairs, fault) = read_with("a.csv", &text, &options);
    assert_eq!((pairs, fault), (vec![[1.0, 2.0]], None));
}

#[test]
fn content_wins_over_the_extension() {
    let mut wav = Cursor::new(Vec::new());
    let spec = hound::WavSpec {
        channels: 2,
        sample_rate: 8,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::new(&mut wav, spec).unwrap();
    writer.write_sample(0x4000i16).unwrap();
    writer.write_sample(-0x4000i16).unwrap();
    writer.finalize().unwrap();
    for name in ["a.wav", "a.WAV", "a.csv", "a.bin", "a"] {
        assert_eq!(
            read(name, wav.get_ref()),
            (vec![[0.5, -0.5]], None),
            "{name}"
        );
    }
}

#[test]
fn a_raw_file_is_read_in_the_format_given() {
    let options = raw(Kind::I16);
    let (_directory, path) = file("a.bin", &[0, 0x40, 0, 0xc0]);
    let mut recording = Recording::open(&path, &options).unwrap();
    assert_eq!(
        (recording.opened.pairs, recording.bytes_total),
        (Some(1), Some(4))
    );
    assert_eq!(
        (recording.opened.sample_rate, recording.full_scale()),
        (None, Some(32_767.0 / 32_768.0))
    );
    assert_eq!(recording.name, path.display().to_string());
    assert_eq!(drain(&mut recording).0, [[0.5, -0.5]]);
    assert_eq!(recording.bytes_read(), 4);
}

#[test]
fn the_format_given_wins_over_a_name_and_not_over_the_content() {
    let options = raw(Kind::I16);
    for name in [
        "a.wav", "a.wave", "a.npy", "a.csv", "a.txt", "a.mat", "a.bin",
    ] {
        let found = read_with(name, &[0, 0x40, 0, 0xc0], &options);
        assert_eq!(found, (vec![[0.5, -0.5]], None), "{name}");
        let told = |bytes| read_with(name, bytes, &options).1.unwrap();
        for (bytes, kind) in [
            (&b"RIFF1234WAVE"[..], "WAV header: "),
            (b"\x93NUMPY\x01\0\x46\0", "NPY header: "),
        ] {
            assert!(told(bytes).starts_with(&format!("{name}: {kind}")));
        }
    }
    // A file is text if both name and content say so, in any encoding.
    for text in [&b"1,2\n"[..], b"x,y\n1,2\n", b"\xe9t\xe9,c,d\n0,1,2\n"] {
        assert_eq!(read_with("a.csv", text, &options).0, [[1.0, 2.0]]);
    }
    assert_eq!(read_with("a.csv", b"~\x80~\x80", &options).0.len(), 1);
    assert_eq!(read_with("a.bin", b"1,2\n", &options).0.len(), 1);
}

#[test]
fn a_stream_needs_a_format_unless_it_is_a_file() {
    let open = |bytes: &[u8], raw| {
        let options = OpenOptions {
            raw,
            ..OpenOptions::default()
        };
        let stream = Box::new(Cursor::new(bytes.to_vec()));
        by_content::open(stream, Known::default(), &options)
            .map(|opened| opened.integers)
            .map_err(|fault| fault.of(STANDARD_INPUT))
    };
    assert!(open(b"abcd", Some(Kind::F32)).is_ok());
    let fault = |bytes, raw| message(open(bytes, raw).err());
    let unknown = fault(b"abcd", None);
    let told = "standard input: this is neither WAV, NPY nor CSV; for raw samples give their format with --raw ";
    assert!(unknown.starts_with(told), "{unknown}");
    assert!(
        unknown.ends_with(", or for text the columns with --columns"),
        "{unknown}"
    );
    assert!(fault(b"", Some(Kind::I16)).starts_with("standard input: there is nothing in it;"));
    assert!(fault(b"RIFF1234WAVE", Some(Kind::I16)).starts_with("standard input: WAV header: "));
    assert!(fault(b"\x93NUMPY", None).starts_with("standard input: NPY header: "));
}

#[test]
fn pairs_behind_a_long_silence_keep_their_order() {
    // Silence of more than two blocks, so that several are read ahead; then all samples differ.
    let pairs = 4 * BLOCK_PAIRS as u32;
    let samples = |k: u32| match k.checked_sub(40_000) {
        Some(after) => [after, after + 1].map(|sample| sample as f32),
        None => [7.0; 2],
    };
    let expected: Vec<[f32; 2]> = (0..pairs).map(samples).collect();
    let text = |line: &dyn Fn(u32) -> String| (0..pairs).map(line).collect::<String>().into_bytes();
    let line = |k| {
        let [c, d] = samples(k);
        format!("{c},{d}\n")
    };
    let bytes = |k| samples(k).map(f32::to_le_bytes).concat();
    let shape = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({pairs}, 2)}}");
    let header = format!("NUMPY\u{1}\0\u{76}\0{shape:<117}\n");
    let npy = iter::once(0x93).chain(header.bytes());
    for (name, content) in [
        ("a.csv", text(&line)),
        (
            "b.csv",
            text(&|k| format!("{},{}", f64::from(k) / 1e5, line(k))),
        ),
        ("c.npy", npy.chain((0..pairs).flat_map(bytes)).collect()),
        ("d.bin", (0..pairs).flat_map(bytes).collect()),
    ] {
        let (read, fault) = read_with(name, &content, &raw(Kind::F32));
        assert_eq!(fault, None, "{name}");
        let wrong = (0..read.len()).find(|&k| read[k] != expected[k]);
        assert_eq!((read.len(), wrong), (expected.len(), None), "{name}");
    }
}

#[test]
fn a_buffer_without_capacity_is_given_some() {
    let (_directory, path) = file("a.csv", b"1,2\n3,4\n");
    let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
    assert_eq!(recording.read(&mut Vec::new()).unwrap(), 2);
}

/// Beginnings that lead deep into each reader.
fn beginnings() -> impl Strategy<Value = Vec<u8>> {
    let wav = b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0\x01\0\x02\0\0\0\x01\0\0\0\x04\0\x04\0\x10\0data";
    prop_oneof![
        Just(Vec::new()),
        Just(b"RIFF\0\0\0\0WAVE".to_vec()),
        Just(b"RF64\xff\xff\xff\xffWAVEds64\x1c\0\0\0".to_vec()),
        Just(b"RIFF\0\0\0\0WAVEfmt \x28\0\0\0\xfe\xff\x02\0".to_vec()),
        Just(wav.to_vec()),
        Just(b"\x93NUMPY\x01\0\x46\0".to_vec()),
        Just(
            b"\x93NUMPY\x02\0\x46\0\0\0{'descr': '<f4', 'fortran_order': True, 'shape': (".to_vec()
        ),
        Just(b"time,c,d\n0,1,2\n1,3,4\n".to_vec()),
        Just(b"1;2\n".to_vec()),
    ]
}

fn text() -> impl Strategy<Value = Vec<u8>> {
    proptest::collection::vec(
        proptest::sample::select(b"0123456789.,;e- \t\r\n#\"'()[]{}<>if:nTF".to_vec()),
        0..300,
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_make_a_reader_panic(
        name in proptest::sample::select(vec!["a.wav", "a.csv", "a.npy", "a.raw"]),
        mut bytes in beginnings(),
        rest in prop_oneof![proptest::collection::vec(any::<u8>(), 0..300), text()],
    ) {
        bytes.extend_from_slice(&rest);
        let (pairs, fault) = read_with(name, &bytes, &raw(Kind::F32));
        prop_assert!(fault.is_some() || !pairs.is_empty());
    }
}
