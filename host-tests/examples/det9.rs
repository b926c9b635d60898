//! scratch
use antinode::period::MeanReturnDetector;
use antinode_sim::{Flaws, Gyro, random_wave};
fn main() {
    let fs = 1e5;
    for &noise in &[0.0, 0.02, 0.2] {
        let mut bad = 0; let mut none = 0; let mut worst = 0f64; let mut sq = 0f64; let mut time = 0f64; let mut maxtime = 0f64; let mut n = 0.0;
        let mut hist = [0usize; 16];
        for seed in 0..10000u64 {
            let u = (seed as f64 * 0.6180339887).fract();
            let p = 4.0 * (50f64).powf(u);
            let w = random_wave(seed, fs / p, 0.5);
            let flaws = Flaws { noise: noise * w.main_amplitude, offset_c: w.main_amplitude * 0.9, offset_d: -0.5 * w.main_amplitude, ..Flaws::default() };
            let gyro = Gyro::new(w, flaws, fs, seed + 7).unwrap();
            let mut det = MeanReturnDetector::new();
            let mut found = None;
            for (k, x) in gyro.take((40.0 * p) as usize).enumerate() {
                if let Some(q) = det.push([x.c as f32, x.d as f32]) { found = Some((k, q as f64)); break; }
            }
            match found { None => { none += 1; if std::env::var("V").is_ok() { println!("none {p:.2} {noise}"); } }, Some((k, q)) => { let e = q / p - 1.0; if e.abs() > 0.2 { bad += 1; println!("bad seed {seed} p {p} q {q} k {k}"); } worst = worst.max(e.abs()); sq += e * e; time += k as f64 / p; maxtime = maxtime.max(k as f64 / p); hist[((k as f64 / p) as usize).min(15)] += 1; n += 1.0; } }
        }
        println!("noise {noise}: bad {bad} none {none} worst {worst:.4} rms {:.4} time {:.2} max {maxtime:.1} {hist:?}", (sq / n).sqrt(), time / n);
    }
    let mut locks = 0;
    for seed in 0..10000u64 {
        let mut w = random_wave(seed, 5000.0, 0.5); w.main_amplitude = 1e-9; w.quadrature_amplitude = 0.0;
        let gyro = Gyro::new(w, Flaws { noise: 1.0, ..Flaws::default() }, fs, seed).unwrap();
        let mut det = MeanReturnDetector::new();
        for x in gyro.take(2000) { if det.push([x.c as f32, x.d as f32]).is_some() { locks += 1; break; } }
    }
    println!("noise locks {locks}");
    let mut t = 0;
    for seed in 0..1000u64 {
        let u = (seed as f64 * 0.6180339887).fract(); let p = 5.0 * (30f64).powf(u); let ratio = 1.15 + 2.0*(seed as f64 * 0.7548776662).fract();
        let w1 = random_wave(seed, fs / p, 0.5); let mut w2 = random_wave(seed + 5000, fs / p / ratio, 0.5); w2.quadrature_amplitude *= w1.main_amplitude / w2.main_amplitude; w2.main_amplitude = w1.main_amplitude;
        let g1 = Gyro::new(w1, Flaws { noise: 0.01, ..Flaws::default() }, fs, seed).unwrap();
        let g2 = Gyro::new(w2, Flaws { noise: 0.01, ..Flaws::default() }, fs, seed + 1).unwrap();
        let mut det = MeanReturnDetector::new();
        for (k,(x, y)) in g1.zip(g2).take(4000).enumerate() { if let Some(q) = det.push([(x.c + y.c) as f32, (x.d + y.d) as f32]) { t += 1; if t < 20 { println!("two tones {p:.2} {:.2} -> {q:.2} at {k}", p * ratio); } break; } }
    }
    println!("two-tone locks {t} of 1000");
}
