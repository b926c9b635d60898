//! scratch
use antinode::block::Demodulator;
use antinode::settings::Settings;
use antinode::tracker::Tracker;
use antinode_sim::{Flaws, Gyro, random_wave};
fn main() {
    let fs = 1e5;
    for &p in &[4.3, 6.1, 18.754688, 60.0, 190.0] {
        for &n in &[2u16, 4, 10, 50, 100] {
            for &(noise, offs) in &[(0.0, 1.0), (0.001, 0.1), (0.02, 0.1), (0.2, 0.1)] {
                let runs = if n > 10 { 20 } else { 100 };
                let mut s = [0f64; 4]; let mut r = [0f64; 4]; let mut q=[0f64;4]; let mut mx=[0f64;4]; let mut cnt = 0.0; let mut fl = 0; let mut nz=0.0;
                let mut names = std::collections::BTreeMap::new();
                for seed in 0..runs {
                    let w = random_wave(seed, fs / p, 0.5);
                    let flaws = Flaws { noise: noise * w.main_amplitude, offset_c: offs*w.main_amplitude, offset_d: -0.7*offs*w.main_amplitude, ..Flaws::default() };
                    let mut gyro = Gyro::new(w, flaws, fs, seed + 77).unwrap();
                    let settings = Settings { periods: n, ..Settings::new(fs) };
                    let off = 1.0 + 0.02 * ((seed as f64 * 0.618).fract() - 0.5)*2.0;
                    let layout = settings.layout((p * off) as f32);
                    let mut demod = Demodulator::<256>::new(layout, 0);
                    let mut tracker = Tracker::<256>::new(settings).unwrap();
                    let mut got = 0;
                    while got < 12 {
                        let x = gyro.next().unwrap();
                        let Some(b) = demod.push([x.c as f32, x.d as f32]) else { continue };
                        let Some(e) = tracker.push(b) else { continue };
                        got += 1;
                        if !e.flags.is_empty() { fl += 1; *names.entry(e.flags.to_string()).or_insert(0)+=1; }
                        let t = w.at(e.time);
                        let bd = host_tests::bound::bound(&w, e.samples, e.time, fs);
                        let hp = std::f64::consts::FRAC_PI_2;
                        let mut da = e.angle - t.angle; da -= (da / hp).round() * hp;
                        let err = [e.main_amplitude as f64 - t.main_amplitude, e.quadrature_amplitude as f64 - t.quadrature_amplitude, da, e.frequency - t.frequency];
                        let sg = noise * w.main_amplitude;
                        let b = if noise > 0.0 { [bd.main * sg, bd.quadrature * sg, bd.angle * sg, bd.frequency * sg] } else { [w.main_amplitude, w.main_amplitude, 1.0, w.frequency] };
                        let sd = [e.main_amplitude_std, e.quadrature_amplitude_std, e.angle_std, e.frequency_std];
                        for i in 0..4 { s[i] += (err[i] / b[i]).powi(2); r[i] += (sd[i] as f64 / b[i]).powi(2); q[i]+= (err[i]/sd[i] as f64).powi(2); mx[i]=mx[i].max((err[i]/b[i]).abs()); }
                        cnt += 1.0; nz += (e.residual_rms as f64/w.main_amplitude).powi(2);
                    }
                }
                let f = |x: [f64; 4]| x.map(|v| (v / cnt).sqrt());
                if noise == 0.0 { println!("P {p} N {n} noise0: max(1e-6) {:.3?} resid {:.1e} flags {fl} {names:?}", mx.map(|v|v*1e6), (nz/cnt).sqrt()); }
                else { println!("P {p} N {n} noise {noise}: rms/bound {:.3?} std/bound {:.3?} z {:.2?} flags {fl} {names:?}", f(s), f(r), f(q)); }
            }
        }
    }
}
