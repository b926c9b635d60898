//! Every number has its range.

use super::*;

#[test]
fn every_number_has_its_range() {
    let none = Flaws::default;
    assert_eq!(none().check(), Ok(()));
    for (flaws, field) in [
        (
            Flaws {
                noise: -1e-9,
                ..none()
            },
            "noise",
        ),
        (
            Flaws {
                coloured_noise: -1e-9,
                ..none()
            },
            "coloured_noise",
        ),
        (
            Flaws {
                coloured_corner: 0.0,
                ..none()
            },
            "coloured_corner",
        ),
        (
            Flaws {
                jitter: f64::NAN,
                ..none()
            },
            "jitter",
        ),
        (
            Flaws {
                offset_c: f64::INFINITY,
                ..none()
            },
            "offset_c",
        ),
        (
            Flaws {
                offset_d: f64::NAN,
                ..none()
            },
            "offset_d",
        ),
        (
            Flaws {
                hum: f64::NAN,
                ..none()
            },
            "hum",
        ),
        (
            Flaws {
                hum_frequency: f64::INFINITY,
                ..none()
            },
            "hum_frequency",
        ),
        (
            Flaws {
                skew: f64::NAN,
                ..none()
            },
            "skew",
        ),
        (
            Flaws {
                pick_off_angle: f64::NAN,
                ..none()
            },
            "pick_off_angle",
        ),
        (
            Flaws {
                cubic: f64::NAN,
                ..none()
            },
            "cubic",
        ),
        (
            Flaws {
                gain_ratio: 0.0,
                ..none()
            },
            "gain_ratio",
        ),
        (
            Flaws {
                clip: Some(0.0),
                ..none()
            },
            "clip",
        ),
        (
            Flaws {
                clip_spans: vec![ClipSpan {
                    from: 0.0,
                    to: 1.0,
                    level: -1.0,
                }],
                ..none()
            },
            "level of clip_spans",
        ),
        (
            Flaws {
                bits: Some(16),
                ..none()
            },
            "full_scale",
        ),
        (
            Flaws {
                bits: Some(33),
                full_scale: 1.0,
                ..none()
            },
            "bits",
        ),
        (
            Flaws {
                bits: Some(1),
                full_scale: 1.0,
                ..none()
            },
            "bits",
        ),
    ] {
        match flaws.check() {
            Err(Error::OutOfRange { what, .. }) => assert_eq!(what, field),
            other => panic!("{field}: {other:?}"),
        }
    }
}

#[test]
fn the_step_of_the_adc() {
    assert_eq!(
        Flaws {
            bits: Some(16),
            full_scale: 2.0,
            ..Flaws::default()
        }
        .lsb(),
        Some(2.0 / 32768.0)
    );
    assert_eq!(Flaws::default().lsb(), None);
}
