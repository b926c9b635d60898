//! NPY files, made by hand and by `numpy`.

mod types;

use std::process::Command;

use super::super::tests::{Dribble, drain, file, message, read};
use super::super::{OpenOptions, Recording};

fn npy(descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let text = format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    [
        &b"\x93NUMPY\x01\0"[..],
        &(text.len() as u16).to_le_bytes(),
        text.as_bytes(),
        data,
    ]
    .concat()
}

fn codes(values: &[i16]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

const PAIRS: [[f32; 2]; 3] = [[0.0, 0.5], [0.25, -0.5], [-1.0, 0.125]];
const INTERLEAVED: [i16; 6] = [0, 0x4000, 0x2000, -0x4000, -0x8000, 0x1000];
const PLANES: [i16; 6] = [0, 0x2000, -0x8000, 0x4000, -0x4000, 0x1000];

#[test]
fn every_layout_is_read() {
    for (fortran, shape, values) in [
        (false, "(3, 2)", INTERLEAVED),
        (true, "(2, 3)", INTERLEAVED),
        (true, "(3, 2)", PLANES),
        (false, "(2, 3)", PLANES),
    ] {
        let bytes = npy("'<i2'", fortran, shape, &codes(&values));
        assert_eq!(
            read("a.npy", &bytes),
            (PAIRS.to_vec(), None),
            "{fortran} {shape}"
        );
        let (_directory, path) = file("a.npy", &bytes);
        let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
        assert_eq!(
            (recording.opened.pairs, recording.opened.sample_rate),
            (Some(3), None)
        );
        assert_eq!(recording.full_scale(), Some(32_767.0 / 32_768.0));
        drain(&mut recording);
        assert_eq!(Some(recording.bytes_read()), recording.bytes_total);
    }
}

#[test]
fn two_pairs_are_interleaved() {
    let bytes = npy("'<i2'", false, "(2, 2)", &codes(&INTERLEAVED[..4]));
    assert_eq!(read("a.npy", &bytes).0, PAIRS[..2]);
}

#[test]
fn other_shapes_and_types_are_named() {
    let fault = |descr, shape| {
        read("a.npy", &npy(descr, false, shape, &[0; 64]))
            .1
            .expect("a fault")
    };
    for (shape, shown) in [
        ("(6,)", "(6,)"),
        ("(2, 3, 4)", "(2, 3, 4)"),
        ("(3, 3)", "(3, 3)"),
        ("()", "()"),
    ] {
        let expected = format!(
            "a.npy: NPY header: the shape is {shown}, but (N, 2) is needed; of more channels choose two, as in --columns 2,3 if the first is the time, or save `numpy.stack("
        );
        assert!(
            fault("'<i2'", shape).starts_with(&expected),
            "{}",
            fault("'<i2'", shape)
        );
    }
    for (descr, shown) in [
        ("'<i8'", "'<i8'"),
        ("'<u4'", "'<u4'"),
        ("'<f16'", "'<f16'"),
        ("'<c16'", "'<c16'"),
        ("'|O'", "'|O'"),
        (
            "[('c', '<f4'), ('d', '<f8')]",
            "[('c', '<f4'), ('d', '<f8'), ]",
        ),
    ] {
        let expected = format!(
            "a.npy: NPY header: the dtype is {shown}, but u1, i1, u2, i2, i4, f2, f4 or f8, or records of one of them, is needed; save "
        );
        assert!(
            fault(descr, "(3, 2)").starts_with(&expected),
            "{}",
            fault(descr, "(3, 2)")
        );
    }
    for shape in ["(0, 2)", "(2, 0)"] {
        let expected = "a.npy: there are no sample pairs in it; ";
        assert!(fault("'<i2'", shape).starts_with(expected));
    }
}

#[test]
fn a_damaged_header_is_named() {
    let fault = |bytes: &[u8]| read("a.npy", bytes).1.expect("a fault");
    let whole = npy("'<i2'", false, "(3, 2)", &[]);
    for end in 6..whole.len() {
        assert!(
            fault(&whole[..end])
                .starts_with("a.npy: NPY header: the file ends inside it; save it again")
        );
    }
    let header = |text: &str| {
        [
            &b"\x93NUMPY\x01\0"[..],
            &(text.len() as u16).to_le_bytes(),
            text.as_bytes(),
        ]
        .concat()
    };
    for text in ["", "{}", "{'descr': '<i2'}", "not a header"] {
        assert!(
            fault(&header(text)).starts_with("a.npy: NPY header: it cannot be understood; "),
            "{text}"
        );
    }
    let deep = "(".repeat(5000);
    let huge = "{'descr': '<i2', 'fortran_order': False, 'shape': (4294967296, 4294967296), }";
    for text in [&deep, huge] {
        let fault = fault(&header(text));
        assert!(
            fault.starts_with("a.npy: NPY header: it cannot be that of an array of numbers; "),
            "{fault}"
        );
    }
    let long = fault(b"\x93NUMPY\x02\0\xff\xff\xff\xff{");
    assert!(long.starts_with("a.npy: NPY header: it is too long for an array of numbers; "));
    assert!(
        fault(b"\x93NUMPY\x09\0\x01\0\0\0{")
            .starts_with("a.npy: NPY header: it cannot be understood; ")
    );
}

#[test]
fn truncated_data_are_delivered_before_the_error() {
    for (shape, values, left) in [("(3, 2)", INTERLEAVED, 2), ("(2, 3)", PLANES, 1)] {
        let bytes = npy("'<i2'", false, shape, &codes(&values));
        let (pairs, fault) = read("a.npy", &bytes[..bytes.len() - 3]);
        assert_eq!(pairs, PAIRS[..left], "{shape}");
        let expected = format!(
            "a.npy: at its end: the header promises 3 sample pairs, but there are {left}; "
        );
        assert!(fault.expect("a fault").starts_with(&expected));
    }
    // Whichever of the channels is cut off.
    let bytes = npy("'<i2'", false, "(2, 3)", &codes(&PLANES));
    let swapped = OpenOptions {
        columns: Some("2,1".parse().unwrap()),
        ..OpenOptions::default()
    };
    let (_directory, path) = file("a.npy", &bytes[..bytes.len() - 3]);
    let (pairs, fault) = drain(&mut Recording::open(&path, &swapped).unwrap());
    assert_eq!(pairs, [[0.5, 0.0]]);
    assert!(message(fault).contains("but there are 1; "));
    let (pairs, fault) = read(
        "a.npy",
        &npy("'<i2'", false, "(2, 3)", &codes(&PLANES[..2])),
    );
    assert!(pairs.is_empty());
    assert!(
        fault
            .expect("a fault")
            .starts_with("a.npy: at its end: the header promises 3 sample pairs, but there are 0")
    );
}

#[test]
fn what_follows_an_array_is_told() {
    for (shape, values) in [("(3, 2)", INTERLEAVED), ("(2, 3)", PLANES)] {
        let bytes = npy("'<i2'", false, shape, &codes(&values));
        let (pairs, fault) = read("a.npy", &[&bytes[..], &bytes].concat());
        assert_eq!(pairs, PAIRS, "{shape}");
        let expected =
            "a.npy: at its end: more data follow the 3 sample pairs that the header promises";
        assert!(fault.expect("a fault").starts_with(expected));
    }
}

#[test]
fn not_finite_is_named_in_either_layout() {
    let count = 40_000;
    let mut values = vec![0.5f32; 2 * count];
    values[2 * 30_000] = f32::NAN;
    let data = |values: &[f32]| {
        values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect::<Vec<u8>>()
    };
    let apart: Vec<f32> = [0, 1]
        .iter()
        .flat_map(|&odd| values.iter().copied().skip(odd).step_by(2))
        .collect();
    for (shape, data) in [("(40000, 2)", data(&values)), ("(2, 40000)", data(&apart))] {
        let (pairs, fault) = read("a.npy", &npy("'<f4'", false, shape, &data));
        assert_eq!(pairs.len(), count);
        assert!(pairs[30_000][0].is_nan() && pairs[30_001] == [0.5, 0.5]);
        let expected = "a.npy: sample pair 30000 (from 0), S_C (left): the value is NaN, not a finite number; ";
        assert!(fault.expect("a fault").starts_with(expected));
    }
}

#[test]
fn a_pipe_cannot_go_back() {
    let open = |shape| {
        let bytes = npy("'<i2'", false, shape, &codes(&INTERLEAVED));
        super::open(
            Box::new(Dribble::new(bytes, 5)),
            super::Known::default(),
            None,
        )
        .map_err(|fault| fault.of("pipe"))
    };
    let mut recording = Recording::new("pipe".to_owned(), open("(3, 2)").unwrap(), None);
    assert_eq!(drain(&mut recording).0, PAIRS);
    assert!(message(open("(2, 3)").err()).starts_with(
        "pipe: the array holds all of S_C before S_D, which cannot be read from a pipe"
    ));
}

#[test]
#[ignore = "needs python3 with numpy"]
fn what_numpy_writes_is_read() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.npy");
    for stack in [
        "n.stack([c, d], 1)",
        "n.stack([c, d])",
        "n.asfortranarray(n.stack([c, d], 1))",
    ] {
        for dtype in ["|u1", "|i1", "<u2", "<i2", ">i4", "<f2", "<f4", ">f8"] {
            let script = format!(
                "import sys, numpy as n\n\
                 c = n.arange(50000) % 100 / 128; d = -c\n\
                 t = n.dtype('{dtype}'); full = 1 if t.kind == 'f' else 2 ** (8 * t.itemsize - 1)\n\
                 n.save(sys.argv[1], (({stack} + (t.kind == 'u')) * full).astype(t))"
            );
            let made = Command::new("python3")
                .arg("-c")
                .arg(script)
                .arg(&path)
                .status();
            assert!(made.unwrap().success(), "{stack} {dtype}");
            let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
            assert_eq!(recording.opened.pairs, Some(50_000));
            let (pairs, fault) = drain(&mut recording);
            assert!(fault.is_none());
            assert_eq!(pairs.len(), 50_000);
            for (k, pair) in pairs.iter().enumerate() {
                let value = (k % 100) as f32 / 128.0;
                assert_eq!(*pair, [value, -value], "{stack} {dtype} {k}");
            }
        }
    }
}
