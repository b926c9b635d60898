//! scratch
use antinode::block::Demodulator;
use antinode::settings::Settings;
use antinode::tracker::Tracker;
use antinode_sim::{Flaws, Gyro, random_wave};
fn main() {
    let fs = 1e5; let p = 190.0; let n = 2;
    for seed in 0..100 {
        let w = random_wave(seed, fs / p, 0.5);
        let a = w.main_amplitude;
        let flaws = Flaws { offset_c: a, offset_d: -0.7*a, ..Flaws::default() };
        let mut gyro = Gyro::new(w, flaws, fs, seed + 77).unwrap();
        let settings = Settings { periods: n, ..Settings::new(fs) };
        let off = 1.0 + 0.02 * ((seed as f64 * 0.618).fract() - 0.5)*2.0;
        let layout = settings.layout((p*off) as f32);
        let mut demod = Demodulator::<256>::new(layout, 0);
        let mut tracker = Tracker::<256>::new(settings).unwrap();
        let mut got = 0;
        while got < 12 {
            let x = gyro.next().unwrap();
            let Some(b) = demod.push([x.c as f32, x.d as f32]) else { continue };
            let Some(e) = tracker.push(b) else { continue };
            if !e.flags.is_empty() { println!("{seed} {got} off {off} {} rms {:e} a {} b {} {} {}", e.flags, e.residual_rms/a as f32, e.main_amplitude, e.quadrature_amplitude, e.frequency*p/fs, e.angle); }
            got += 1;
        }
    }
}
