//! Every kind of sample at its rails and in between.

use super::*;

fn decode(code: SampleCode, bytes: &[u8]) -> (Vec<[f32; 2]>, Option<String>) {
    let mut pairs = Vec::new();
    let bad = code.decode(bytes, &mut pairs, 70).err();
    (pairs, bad.map(|bad| bad.of("a").to_string()))
}

#[test]
fn integers_scale_to_one() {
    let code = SampleCode::new;
    assert_eq!(decode(code(Kind::U8), &[0, 255]).0, [[-1.0, 127.0 / 128.0]]);
    assert_eq!(
        decode(code(Kind::I8), &[0x80, 127]).0,
        [[-1.0, 127.0 / 128.0]]
    );
    assert_eq!(
        decode(code(Kind::U16), &[0, 0, 0xff, 0xff, 0, 0x80, 0, 0x40]).0,
        [[-1.0, 32_767.0 / 32_768.0], [0.0, -0.5]]
    );
    assert_eq!(
        decode(code(Kind::U16).big_endian(true), &[0x80, 0, 0xc0, 0]).0,
        [[0.0, 0.5]]
    );
    assert_eq!(
        decode(code(Kind::I16), &[0, 0x80, 0xff, 0x7f]).0,
        [[-1.0, 32_767.0 / 32_768.0]]
    );
    assert_eq!(
        decode(code(Kind::I16).big_endian(true), &[0x80, 0, 0x40, 0]).0,
        [[-1.0, 0.5]]
    );
    assert_eq!(
        decode(code(Kind::I24), &[0, 0, 0x80, 0xff, 0xff, 0x7f]).0,
        [[-1.0, 8_388_607.0 / 8_388_608.0]]
    );
    assert_eq!(
        decode(code(Kind::I24).big_endian(true), &[0x80, 0, 0, 0x40, 0, 0]).0,
        [[-1.0, 0.5]]
    );
    assert_eq!(
        decode(code(Kind::I32), &[0, 0, 0, 0x80, 0, 0, 0, 0x40]).0,
        [[-1.0, 0.5]]
    );
    assert_eq!(
        decode(
            code(Kind::I32).big_endian(true),
            &[0x80, 0, 0, 0, 0x40, 0, 0, 0]
        )
        .0,
        [[-1.0, 0.5]]
    );
}

#[test]
fn full_scale_is_the_largest_code() {
    for (kind, top) in [
        (Kind::U8, &[255][..]),
        (Kind::I8, &[127]),
        (Kind::U16, &[0xff, 0xff]),
        (Kind::I16, &[0xff, 0x7f]),
        (Kind::I24, &[0xff, 0xff, 0x7f]),
        (Kind::I32, &[0xff, 0xff, 0xff, 0x7f]),
    ] {
        let code = SampleCode::new(kind);
        assert_eq!(
            decode(code, &[top, top].concat()).0[0][0],
            code.full_scale()
        );
    }
    let code = SampleCode::new(Kind::I32).valid_bits(24);
    assert_eq!(
        decode(code, &[0, 0xff, 0xff, 0x7f, 0, 0xff, 0xff, 0x7f]).0[0][1],
        code.full_scale()
    );
    assert_eq!(code.integers(), Some(code));
    assert_eq!(SampleCode::new(Kind::F32).integers(), None);
    assert_eq!(SampleCode::new(Kind::F16).integers(), None);
}

#[test]
fn floats_pass_whatever_they_are() {
    let values = [0.25f32, -0.5, 1.5, f32::NEG_INFINITY, 1.0, 1.0];
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let (pairs, bad) = decode(SampleCode::new(Kind::F32), &bytes);
    assert_eq!((pairs.as_flattened(), bad), (&values[..], None));

    let values = [0.25f64, 1.0e300];
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_be_bytes())
        .collect();
    let (pairs, bad) = decode(SampleCode::new(Kind::F64).big_endian(true), &bytes);
    assert_eq!((pairs, bad), (vec![[0.25, f32::INFINITY]], None));
}

#[test]
fn bits_below_the_valid_ones_are_refused() {
    let code = SampleCode::new(Kind::I32).valid_bits(24);
    let (pairs, bad) = decode(code, &[0, 0, 0, 1, 0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(pairs.len(), 1);
    let expected = "a: sample pair 71 (from 0), S_C (left): bits are set below the 24 valid ones of a 32-bit sample, ";
    assert!(bad.expect("a fault").starts_with(expected));
}

#[test]
fn codes_are_scaled_as_they_are_decoded() {
    for (kind, codes, bytes) in [
        (Kind::U8, [3.0, 200.0], vec![3, 200]),
        (Kind::I8, [-128.0, 127.0], vec![0x80, 0x7f]),
        (Kind::U16, [0.0, 4095.0], vec![0, 0, 0xff, 0x0f]),
        (Kind::I16, [0.0, 4095.0], vec![0, 0, 0xff, 0x0f]),
        (Kind::I24, [-2.0, 1.0], vec![0xfe, 0xff, 0xff, 1, 0, 0]),
        (
            Kind::I32,
            [-2.0, 65_536.0],
            vec![0xfe, 0xff, 0xff, 0xff, 0, 0, 1, 0],
        ),
    ] {
        let code = SampleCode::new(kind);
        let decoded = decode(code, &bytes).0[0].map(f64::from);
        assert_eq!(code.scaled(codes), Some(decoded), "{kind:?}");
    }
    let code = SampleCode::new(Kind::U8);
    for none in [[-1.0, 3.0], [0.0, 256.0], [0.5, 3.0]] {
        assert_eq!(code.scaled(none), None);
    }
}
