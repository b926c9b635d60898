//! Waves and flaws as JSON.

use antinode_sim::{Channel, ClipSpan, Dropout, DropoutKind, Flaws, Loss, Wave, random_wave};

#[test]
fn json_keeps_everything_and_fills_in_the_rest() {
    let flaws = Flaws {
        noise: 0.1,
        clip: Some(1.5),
        bits: Some(24),
        full_scale: 2.5,
        lost: vec![Loss { at: 3, count: 4 }],
        dropouts: vec![Dropout {
            from: 0.1,
            to: 0.2,
            kind: DropoutKind::NoiseOnly,
            channel: Some(Channel::D),
        }],
        clip_spans: vec![ClipSpan {
            from: 0.3,
            to: 0.4,
            level: 1.0,
        }],
        ..Flaws::default()
    };
    let json = serde_json::to_string(&flaws).unwrap();
    assert_eq!(serde_json::from_str::<Flaws>(&json).unwrap(), flaws);
    assert_eq!(
        serde_json::from_str::<Flaws>("{}").unwrap(),
        Flaws::default()
    );
    assert!(serde_json::from_str::<Flaws>(r#"{"noize": 1}"#).is_err());
    let wave = Wave {
        damping_split: 0.01,
        damping_angle: 0.3,
        frequency_split: -0.002,
        frequency_angle: -0.1,
        ..random_wave(3, 5332.1, 0.5)
    };
    let json = serde_json::to_string(&wave).unwrap();
    assert_eq!(serde_json::from_str::<Wave>(&json).unwrap(), wave);
    // One written before there were splits.
    let before = r#"{"main_amplitude": 2.0, "quadrature_amplitude": 0.1, "decay_rate": 0.0}"#;
    assert_eq!(
        serde_json::from_str::<Wave>(before).unwrap(),
        Wave::default()
    );
}
